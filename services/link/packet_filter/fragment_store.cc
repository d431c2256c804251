#include "services/link/packet_filter/fragment_store.h"

#include <algorithm>

#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kSampleBytes = 256;  // of what is kept of a sample, besides its pieces
constexpr std::size_t kPieceBytes = 24;    // of each fragment, whether it came or not
constexpr std::uint8_t kOctetsToQos = 16;

void Append(Bytes bytes, OwnedPacket* to) {
  const std::size_t before = to->size();
  to->resize(before + bytes.size());
  std::ranges::copy(bytes, to->begin() + static_cast<std::ptrdiff_t>(before));
}

void AppendHeader(SubmessageKind kind, std::uint8_t flags, std::uint8_t length, OwnedPacket* to) {
  const bool little = (flags & 1U) != 0;
  const std::uint8_t none = 0;
  for (const std::uint8_t byte :
       {static_cast<std::uint8_t>(kind), flags, little ? length : none, little ? none : length}) {
    to->push_back(byte);
  }
}

}  // namespace

OwnedPacket WithoutFragments(Bytes packet) {
  OwnedPacket rest(packet.begin(), packet.begin() + kRtpsHeaderBytes);
  SubmessageWalk walk(packet);
  Submessage part;
  bool says_more = false;
  while (walk.Next(&part)) {
    if (part.kind == SubmessageKind::kDataFrag) continue;
    says_more |= part.kind != SubmessageKind::kInfoTs && part.kind != SubmessageKind::kInfoDst &&
                 part.kind != SubmessageKind::kInfoSrc;
    const std::size_t size = kSubmessageHeaderBytes + Padded(part.body.size());
    Append(packet.subspan(walk.Start(), std::min(size, packet.size() - walk.Start())), &rest);
  }
  if (!says_more) rest.clear();
  return rest;
}

// All of a sample, as its writer would send it if datagrams were longer.
OwnedPacket FragmentStore::WholeOf(const Sample& sample, const PrefixBytes& source, Bytes packet) {
  OwnedPacket whole(packet.begin(), packet.begin() + kSenderAt);
  Append(source, &whole);
  if (sample.destination != PrefixBytes{}) {
    AppendHeader(SubmessageKind::kInfoDst, 1, std::tuple_size_v<PrefixBytes>, &whole);
    Append(sample.destination, &whole);
  }
  Append(sample.time, &whole);
  const bool little = (sample.flags & 1U) != 0;
  const std::uint8_t none = 0;
  const auto flags = static_cast<std::uint8_t>(sample.flags | kWithData);
  AppendHeader(SubmessageKind::kData, flags, 0, &whole);  // to the end of the packet
  whole.insert(whole.end(), {0, 0, little ? kOctetsToQos : none, little ? none : kOctetsToQos});
  Append(sample.reader, &whole);
  Append(sample.writer_and_number, &whole);
  Append(sample.inline_qos, &whole);
  for (const std::vector<std::uint8_t>& piece : sample.pieces) Append(piece, &whole);
  return whole;
}

std::vector<OwnedPacket> FragmentStore::Take(Bytes packet, const ParticipantTable& participants) {
  std::vector<OwnedPacket> whole;
  PacketContext context(packet);
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    context.Note(part);
    if (part.kind != SubmessageKind::kDataFrag) continue;
    const bool is_known = participants.Knows(context.Source());
    std::optional<OwnedPacket> completed = Add(part, context, packet, is_known);
    if (completed) whole.push_back(std::move(*completed));
  }
  return whole;
}

std::optional<OwnedPacket> FragmentStore::Add(const Submessage& frag, const PacketContext& context,
                                              Bytes packet, bool is_known) {
  const auto found = Find(frag, context, is_known);
  Sample& sample = found->second;
  if (sample.destination != context.destination) sample.destination = {};
  const Bytes reader = frag.body.subspan(kReaderInData, sample.reader.size());
  if (!std::ranges::equal(sample.reader, reader)) sample.reader = {};
  KeepHead(frag, context, &sample);
  Keep(frag, &sample);
  sample.turns->splice(sample.turns->end(), *sample.turns, sample.turn);
  if (sample.missing > 0) {
    MakeRoom();
    return std::nullopt;
  }
  OwnedPacket whole = WholeOf(sample, context.Source(), packet);
  kept_bytes_ -= sample.kept_bytes;
  sample.turns->erase(sample.turn);
  samples_.erase(found);
  return whole;
}

std::map<FragmentStore::Key, FragmentStore::Sample>::iterator FragmentStore::Find(
    const Submessage& frag, const PacketContext& context, bool is_known) {
  const Fragment fragment = FragmentOf(frag);
  Key key{};
  auto end = std::ranges::copy(context.Source(), key.begin()).out;
  end = std::ranges::copy(frag.body.subspan(kWriterInData, 4), end).out;
  for (int shift = 0; shift < 64; shift += 8) {
    *end++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(fragment.number) >> shift);
  }
  for (int shift = 0; shift < 32; shift += 8) {
    *end++ = static_cast<std::uint8_t>(fragment.sample_bytes >> shift);
  }
  *end++ = static_cast<std::uint8_t>(fragment.fragment_bytes);
  *end = static_cast<std::uint8_t>(fragment.fragment_bytes >> 8U);
  const auto [found, is_new] = samples_.try_emplace(key);
  if (!is_new) return found;
  Sample& sample = found->second;
  sample.missing =
      (fragment.sample_bytes + fragment.fragment_bytes - 1) / std::size_t{fragment.fragment_bytes};
  sample.pieces.resize(sample.missing);
  sample.kept_bytes = kSampleBytes + kPieceBytes * sample.missing;
  sample.destination = context.destination;
  std::ranges::copy(frag.body.subspan(kReaderInData, sample.reader.size()), sample.reader.begin());
  sample.flags = frag.flags & 1U;
  std::ranges::copy(frag.body.subspan(kWriterInData, sample.writer_and_number.size()),
                    sample.writer_and_number.begin());
  sample.turns = is_known ? &turns_ : &turns_of_unknown_;
  sample.turn = sample.turns->insert(sample.turns->end(), key);
  kept_bytes_ += sample.kept_bytes;
  return found;
}

// What the first fragment says besides, or, until that has come, another one.
void FragmentStore::KeepHead(const Submessage& frag, const PacketContext& context, Sample* sample) {
  const bool is_first = FragmentOf(frag).first == 1 && sample->pieces[0].empty();
  if (context.time && (is_first || sample->time.empty())) {
    constexpr std::uint8_t kTimeBytes = 8;
    sample->time.clear();
    AppendHeader(SubmessageKind::kInfoTs, context.time->flags & 1U, kTimeBytes, &sample->time);
    Append(context.time->body.first(kTimeBytes), &sample->time);
  }
  const Bytes inline_qos = PartsOfFragment(frag).inline_qos;
  if (inline_qos.empty() || (!is_first && !sample->inline_qos.empty())) return;
  sample->kept_bytes += inline_qos.size() - sample->inline_qos.size();
  kept_bytes_ += inline_qos.size() - sample->inline_qos.size();
  sample->inline_qos.assign(inline_qos.begin(), inline_qos.end());
  sample->flags = frag.flags & (1U | kInlineQos);
  std::ranges::copy(frag.body.subspan(kWriterInData, sample->writer_and_number.size()),
                    sample->writer_and_number.begin());
}

// The fragments that stand in one submessage, of those that have not come.
void FragmentStore::Keep(const Submessage& frag, Sample* sample) {
  const Fragment fragment = FragmentOf(frag);
  const Bytes payload = PartsOfFragment(frag).payload;
  for (std::size_t i = 0; i < fragment.count; ++i) {
    std::vector<std::uint8_t>& piece = sample->pieces[fragment.first - 1 + i];
    if (!piece.empty()) continue;
    const std::size_t from = i * fragment.fragment_bytes;
    const std::size_t before = (fragment.first - std::size_t{1}) * fragment.fragment_bytes + from;
    const std::size_t bytes =
        std::min<std::size_t>(fragment.fragment_bytes, fragment.sample_bytes - before);
    piece.assign(payload.begin() + static_cast<std::ptrdiff_t>(from),
                 payload.begin() + static_cast<std::ptrdiff_t>(from + bytes));
    --sample->missing;
    sample->kept_bytes += bytes;
    kept_bytes_ += bytes;
  }
}

void FragmentStore::MakeRoom() {
  while (kept_bytes_ > most_bytes_ && samples_.size() > 1) {
    std::list<Key>& turns = turns_of_unknown_.empty() ? turns_ : turns_of_unknown_;
    const auto oldest = samples_.find(turns.front());
    kept_bytes_ -= oldest->second.kept_bytes;
    samples_.erase(oldest);
    turns.pop_front();
  }
}

}  // namespace giveway::link
