#include "services/link/impairment/impaired_transport.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "services/link/impairment/delay_line.h"

namespace giveway::link {
namespace {

using std::chrono::steady_clock;

struct ImpairedDescriptor final : transport::ChainingTransportDescriptor {
  ImpairedDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> udp,
                     std::shared_ptr<Impairer> of_participant)
      : ChainingTransportDescriptor(std::move(udp)), impairer(std::move(of_participant)) {}
  transport::TransportInterface* create_transport() const override;

  std::shared_ptr<Impairer> impairer;
};

class ImpairedTransport final : public ForwardingTransport {
 public:
  explicit ImpairedTransport(const ImpairedDescriptor& descriptor)
      : ForwardingTransport(descriptor), descriptor_(descriptor) {}

  // The library asks for it at every turn: null ends the process.
  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  // On the library's threads, one a port.
  void receive(transport::TransportReceiverInterface* receiver, const rtps::octet* bytes,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override;

  // The receiver may go as soon as this returns.
  bool CloseInputChannel(const rtps::Locator_t& local) override {
    const bool closed = ForwardingTransport::CloseInputChannel(local);
    descriptor_.impairer->NoteAbandoned(line_.Forget(local.port));
    return closed;
  }

 private:
  void Push(steady_clock::time_point due, LatePacket packet) {
    if (!line_.Push(due, std::move(packet))) descriptor_.impairer->NoteAbandoned(1);
  }

  ImpairedDescriptor descriptor_;
  DelayLine line_;
};

transport::TransportInterface* ImpairedDescriptor::create_transport() const {
  return new ImpairedTransport(*this);  // the library owns it
}

void ImpairedTransport::receive(transport::TransportReceiverInterface* receiver,
                                const rtps::octet* bytes, std::uint32_t size,
                                const rtps::Locator_t& local, const rtps::Locator_t& remote) {
  const auto now = steady_clock::now();
  const PacketFate fate =
      descriptor_.impairer->Decide({bytes, size}, SteadyTime(now.time_since_epoch()));
  if (fate.dropped) return;
  const bool untouched = !fate.flipped_bit && !fate.copy_delay && fate.delay == Nanoseconds{0};
  if (untouched) return receiver->OnDataReceived(bytes, size, local, remote);

  LatePacket packet{{bytes, bytes + size}, receiver, local, remote};
  if (fate.flipped_bit) {
    packet.bytes[*fate.flipped_bit / 8] ^= static_cast<rtps::octet>(1U << (*fate.flipped_bit % 8));
  }
  if (fate.copy_delay) Push(now + *fate.copy_delay, packet);
  if (fate.delay == Nanoseconds{0}) return packet.HandOn();
  Push(now + fate.delay, std::move(packet));
}

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> MakeImpairedTransport(
    std::shared_ptr<transport::TransportDescriptorInterface> udp,
    std::shared_ptr<Impairer> impairer) {
  return std::make_shared<ImpairedDescriptor>(std::move(udp), std::move(impairer));
}

PrefixBytes BytesOf(const rtps::GuidPrefix_t& prefix) {
  PrefixBytes bytes;
  static_assert(sizeof(prefix.value) == sizeof(bytes));
  std::copy_n(prefix.value, bytes.size(), bytes.begin());
  return bytes;
}

void NamingListener::OnWriter(Change change, const rtps::GUID_t& writer,
                              const std::vector<std::string>& partitions) {
  const PrefixBytes process = BytesOf(writer.guidPrefix);
  if (change == Change::kFound) {
    impairer_->OnWriter(process, partitions);
  } else {
    impairer_->OnWriterGone(process, partitions);
  }
  next_.OnWriter(change, writer, partitions);
}

}  // namespace giveway::link
