#include "services/fleetctl/args/duration_flag.h"

#include <utility>

#include "services/config/flag_values.h"

namespace giveway::fleetctl {

namespace {

struct TimeRange {
  bool with_zero;
  double most_s;
  const char* text;
};
constexpr TimeRange kDurations{true, kLongestDuration_s,
                               "of 0 to 30 days, such as 90s, 30m, 8h or 2d"};
// Eleven days; the clock's arithmetic overflows beyond 2^33.
constexpr TimeRange kTimes{false, 1e6, "above 0 and up to 1000000 s, such as 5, 90s or 30m"};

CLI::Option* AddFlag(CLI::App* verb, const std::string& name, std::function<void(double)> take_s,
                     const std::string& description, const TimeRange& range) {
  return verb
      ->add_option_function<std::string>(
          name,
          [take = std::move(take_s)](const std::string& text) {
            take(ParseDuration_s(text).value_or(0));
          },
          description)
      ->type_name("TIME")
      ->check([&range](const std::string& text) {
        const auto time_s = ParseDuration_s(text);
        const bool fits = time_s && *time_s <= range.most_s && (range.with_zero || *time_s > 0);
        return fits ? "" : std::string("must be a time ") + range.text + ", not '" + text + "'";
      });
}

}  // namespace

CLI::Option* AddDurationFlag(CLI::App* verb, const std::string& name, double* duration_s,
                             const std::string& description) {
  return AddFlag(
      verb, name, [duration_s](double value_s) { *duration_s = value_s; }, description, kDurations);
}

CLI::Option* AddDurationFlag(CLI::App* verb, const std::string& name,
                             std::optional<double>* duration_s, const std::string& description) {
  return AddFlag(
      verb, name, [duration_s](double value_s) { *duration_s = value_s; }, description, kDurations);
}

CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name,
                         std::function<void(double)> take_s, const std::string& description) {
  return AddFlag(verb, name, std::move(take_s), description, kTimes);
}

CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, double* duration_s,
                         const std::string& description) {
  return AddTimeFlag(
      verb, name, [duration_s](double value_s) { *duration_s = value_s; }, description);
}

CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, std::optional<double>* duration_s,
                         const std::string& description) {
  return AddTimeFlag(
      verb, name, [duration_s](double value_s) { *duration_s = value_s; }, description);
}

}  // namespace giveway::fleetctl
