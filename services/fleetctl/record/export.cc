#include "services/fleetctl/record/export.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "services/fleetctl/args/observer_session.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/record/export_csv.h"
#include "services/link/sample_codec.h"
#include "services/mcap/mcap_reader.h"
#include "services/observer/fleet/sample_json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr int kNotAllExported = 1;

class Exporting {
 public:
  explicit Exporting(const ExportOptions& options) : options_(options) {}

  int Run() {
    std::ifstream file(options_.file, std::ios::binary);
    if (!file) {
      std::fprintf(stderr, "%s: cannot be read: %s\n", options_.file.c_str(), std::strerror(errno));
      return kCouldNotRun;
    }
    return options_.csv ? RunCsv(&file) : Finish(Write(&file));
  }

 private:
  using Use = std::function<bool(Json sample)>;  // false: enough

  // What is damaged is known from the first reading; the second ends with the samples of the first.
  int RunCsv(std::ifstream* file) {
    const mcap::ReadResult all = ReadColumns(file);
    if (!Rewind(file)) {
      std::fprintf(stderr, "%s: cannot be read a second time, as CSV needs it; --json reads once\n",
                   options_.file.c_str());
      return kCouldNotRun;
    }
    const std::uint64_t unreadable = std::exchange(unreadable_, 0);
    if (samples_ > 0) output_ = WriteStdout(columns_.Head());
    Write(file);
    unreadable_ = unreadable;
    return Finish(all);
  }

  mcap::ReadResult Write(std::ifstream* file) {
    return Read(file, [this](Json sample) {
      ++written_;
      output_ = WriteStdout(options_.csv ? columns_.Row(Flattened(sample))
                                         : JsonText(std::move(sample)) + "\n");
      // A growing file may have further columns by now.
      return output_ == WriteResult::kWritten && written_ != samples_;
    });
  }

  // Optional fields come and go: the names of all samples are collected before the header is
  // written.
  mcap::ReadResult ReadColumns(std::ifstream* file) {
    return Read(file, [this](const Json& sample) {
      ++samples_;
      columns_.Add(Flattened(sample));
      return true;
    });
  }

  static bool Rewind(std::ifstream* file) {
    file->clear();
    file->seekg(0);
    return file->good();
  }

  mcap::ReadResult Read(std::ifstream* file, Use use) {
    use_ = std::move(use);
    enough_ = false;
    return mcap::McapReader::Read(
        [file](char* to, std::size_t most) {
          file->read(to, static_cast<std::streamsize>(most));
          return static_cast<std::size_t>(file->gcount());
        },
        [this](const mcap::Message& message, const mcap::Channel& channel, const mcap::Schema&) {
          topics_.insert(channel.topic);
          return channel.topic != options_.topic || Take(message);
        });
  }

  bool Take(const mcap::Message& message) {
    link::Observed observed;
    const link::Decoded decoded = link::DecodeInto(options_.topic, message.data, &observed);
    if (decoded == link::Decoded::kUnreadable) ++unreadable_;
    if (decoded == link::Decoded::kYes) WriteAll(message, observed);
    if (options_.topic == "fleet/motor_command") TakeCommand(message);
    return !enough_;
  }

  void TakeCommand(const mcap::Message& message) {
    const auto command = link::DecodeMotorCommand(message.data);
    if (!command) {
      ++unreadable_;
      return;
    }
    WriteOne(message, *command);
  }

  void WriteAll(const mcap::Message& message, const link::Observed& observed) {
    for (const auto& sample : observed.beacons) WriteOne(message, sample);
    for (const auto& sample : observed.statuses) WriteOne(message, sample);
    for (const auto& sample : observed.truths) WriteOne(message, sample);
    for (const auto& sample : observed.events) WriteOne(message, sample);
    for (const auto& sample : observed.roster) WriteOne(message, sample);
    for (const auto& sample : observed.signals) WriteOne(message, sample);
    for (const auto& sample : observed.ranges) WriteOne(message, sample);
    if (observed.figures) WriteOne(message, *observed.figures);
  }

  template <typename Sample>
  void WriteOne(const mcap::Message& message, const Sample& sample) {
    Json object;
    object["log_ns"] = message.log_ns;
    object["publish_ns"] = message.publish_ns;
    AddFields(sample, &object);
    if (!enough_) enough_ = !use_(std::move(object));
  }

  // Of the whole file: where nothing is of the topic, all of it has been read.
  std::string Topics() const {
    if (topics_.empty()) return "no samples";
    return Printable(Shortened(fmt::format("{}", fmt::join(topics_, ", ")), kMostTopicsBytes));
  }

  int Finish(const mcap::ReadResult& result) const {
    if (output_ != WriteResult::kWritten) return ExitCodeOf(output_);
    if (!result.fault.empty()) {
      std::fprintf(stderr, "%s: %s\n", options_.file.c_str(),
                   Printable(Shortened(result.fault, kMostFaultBytes)).c_str());
    }
    if (unreadable_ > 0) {
      std::fprintf(stderr, "%s: %llu samples of %s could not be decoded\n", options_.file.c_str(),
                   static_cast<unsigned long long>(unreadable_), options_.topic.c_str());
    }
    if (result.cut_off) {
      std::fprintf(stderr, "%s: ends without its summary, as after kill -9\n",
                   options_.file.c_str());
    }
    if (written_ == 0) {
      std::fprintf(stderr, "%s: nothing of %s; it has %s\n", options_.file.c_str(),
                   options_.topic.c_str(), Topics().c_str());
    }
    return result.fault.empty() && unreadable_ == 0 && written_ > 0 ? 0 : kNotAllExported;
  }

  static constexpr std::size_t kMostTopicsBytes = 4096;
  static constexpr std::size_t kMostFaultBytes = 400;
  const ExportOptions& options_;
  CsvColumns columns_;
  Use use_;
  bool enough_ = false;
  std::set<std::string> topics_;  // of the samples read so far
  WriteResult output_ = WriteResult::kWritten;
  std::uint64_t samples_ = 0;  // of the topic, as far as the columns are those of them all
  std::uint64_t written_ = 0;
  std::uint64_t unreadable_ = 0;
};

}  // namespace

int RunExport(const ExportOptions& options) { return Exporting(options).Run(); }

}  // namespace giveway::fleetctl
