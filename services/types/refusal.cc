#include "services/types/refusal.h"

#include <array>
#include <charconv>
#include <string_view>

namespace giveway {
namespace {

// As short as it can be and still the same number.
std::string Text(double number) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

}  // namespace

std::string Describe(const FieldFault& fault) {
  std::string text = std::string(fault.field) + " is " + Text(fault.value) + ", must be ";
  text += Text(fault.least);
  if (fault.least != fault.most) text += " to " + Text(fault.most);
  return text;
}

std::string Describe(const Refusal& refusal) {
  const bool is_vowel = std::string_view("aeiou").find(refusal.sample[0]) != std::string_view::npos;
  std::string text = std::string(is_vowel ? "refuses an " : "refuses a ") + refusal.sample;
  if (refusal.vehicle != kNoVehicle)
    text += " of vehicle " + std::to_string(Number(refusal.vehicle));
  return text + ": " + refusal.why + " (" + refusal.counter + ')';
}

}  // namespace giveway
