#include "services/qos/schema_check.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "services/qos/policy.h"
#include "services/qos/schema.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr char kRefused[] = "The library refuses the whole file, and no process starts.";
constexpr char kUnknown[] =
    "Fast DDS refuses the whole file, and no process starts; what 3.1 alone knows stops every "
    "process with 2.9.";
constexpr std::size_t kShown = 40;  // characters of a wrong value that are quoted

std::string Quoted(std::string_view text) {
  std::string shown(text.substr(0, kShown));
  return "\"" + shown + (text.size() > kShown ? "…" : "") + "\"";
}

class Checker {
 public:
  Checker(const std::string& file, Findings* findings) : file_(file), findings_(*findings) {}

  void CheckRoot(const XmlElement& root);

 private:
  void CheckProfiles(const XmlElement& profiles);
  void CheckProfile(const XmlElement& profile);
  void CheckTransports(const XmlElement& descriptors);
  void CheckChildren(const XmlElement& parent, std::span<const ElementRule> rules);
  void CheckElement(const XmlElement& element, const ElementRule& rule);
  void CheckText(const XmlElement& element, const ElementRule& rule);
  void CheckDuration(const XmlElement& element);
  void CheckName(const XmlElement& profile);
  void AddUnknown(const XmlElement& element, const XmlElement& parent, std::string known);
  void AddWrong(const XmlElement& element, const std::string& must_be);
  void Add(const std::string& rule, const XmlElement& element, std::string values,
           std::string remedy, Severity severity = Severity::kError,
           std::string consequence = kRefused) {
    findings_.push_back({severity,
                         rule,
                         {file_, element.line},
                         "<" + element.name + ">",
                         std::move(values),
                         std::move(consequence),
                         std::move(remedy)});
  }

  const std::string& file_;
  Findings& findings_;
};

std::string Names(std::span<const ElementRule> rules) {
  std::string names;
  for (const ElementRule& rule : rules) {
    names += (names.empty() ? "" : ", ") + std::string(rule.name);
  }
  return names;
}

void Checker::AddUnknown(const XmlElement& element, const XmlElement& parent, std::string known) {
  Add("unknown_element", element, "is no element of <" + parent.name + ">",
      "remove it, or write one of: " + std::move(known), Severity::kError, kUnknown);
}

void Checker::AddWrong(const XmlElement& element, const std::string& must_be) {
  Add("wrong_value", element, Quoted(element.text) + " is not " + must_be, "write " + must_be);
}

void Checker::CheckDuration(const XmlElement& element) {
  for (const XmlElement& child : element.children) {
    if (child.name != "sec" && child.name != "nanosec") AddUnknown(child, element, "sec, nanosec");
  }
  if (!ParseDuration(element)) {
    Add("wrong_value", element, "is not a duration",
        "write <sec> from 0 to 2147483647 and <nanosec> from 0 to 999999999, or DURATION_INFINITY");
  }
}

void Checker::CheckText(const XmlElement& element, const ElementRule& rule) {
  const auto number = ParseNumber(element.text);
  switch (rule.content) {
    case Content::kWord:
      if (WordIndex(rule.words, element.text) < 0) {
        AddWrong(element, "one of " + std::string(rule.words));
      }
      break;
    case Content::kUnsigned:
      if (!number || *number < 0 || *number > 0xffff'ffff) AddWrong(element, "a number from 0");
      break;
    case Content::kInteger:
      if (!number || *number < -1 || *number > 0x7fff'ffff) {
        AddWrong(element, "a number from -1 to 2147483647");
      }
      break;
    case Content::kFlag:
      if (!ParseFlag(element.text)) AddWrong(element, "true or false");
      break;
    case Content::kText:
      if (element.text.empty()) AddWrong(element, "a text");
      break;
    default:
      return;
  }
  for (const XmlElement& child : element.children) AddUnknown(child, element, "nothing");
}

void Checker::CheckElement(const XmlElement& element, const ElementRule& rule) {
  if (rule.content == Content::kOpaque) return;
  if (rule.gone_in_3) {
    Add("removed_element", element, "is an element of Fast DDS 2.9 alone", "remove it",
        Severity::kError,
        "Every process with Fast DDS 3 refuses the whole file, and does not start.");
  }
  if (rule.content == Content::kNoEffect) {
    Add("no_effect", element, "is accepted by Fast DDS and not looked at",
        "remove it: whoever reads the file believes it holds", Severity::kWarning,
        "Nothing changes; the policy stays what it is without it.");
  } else if (rule.content == Content::kDuration) {
    CheckDuration(element);
  } else if (rule.content != Content::kElements) {
    CheckText(element, rule);
  } else if (rule.must_hold && element.children.empty()) {
    Add("empty_element", element, "holds nothing", "write one of: " + Names(rule.children));
  } else {
    CheckChildren(element, rule.children);
  }
}

void Checker::CheckChildren(const XmlElement& parent, std::span<const ElementRule> rules) {
  std::set<std::string_view> seen;
  for (const XmlElement& child : parent.children) {
    const auto rule = std::ranges::find(rules, child.name, &ElementRule::name);
    if (rule == rules.end()) {
      AddUnknown(child, parent, Names(rules));
      continue;
    }
    if (!seen.insert(rule->name).second && !rule->repeats) {
      Add("repeated_element", child, "stands twice in <" + parent.name + ">",
          "keep the one that is meant", Severity::kError,
          "The library takes the last of them, or refuses the whole file.");
    }
    CheckElement(child, *rule);
  }
}

void Checker::CheckName(const XmlElement& profile) {
  if (profile.Attribute("profile_name").empty()) {
    Add("unnamed_profile", profile, "has no attribute profile_name",
        "name it; the services take profiles by name", Severity::kError,
        "The library refuses the whole file, or keeps a profile that nobody can ask for.");
  }
  for (const XmlAttribute& attribute : profile.attributes) {
    if (attribute.name == "profile_name" || attribute.name == "is_default_profile") continue;
    Add("unknown_attribute", profile, Quoted(attribute.name) + " is no attribute of a profile",
        "write profile_name or is_default_profile", Severity::kWarning,
        "The library does not look at it.");
  }
  if (profile.Attribute("is_default_profile") == "true") {
    Add("default_profile", profile, "is_default_profile is true", "remove the attribute",
        Severity::kWarning,
        "Every other entity of the process takes this profile too; the services name theirs.");
  }
}

void Checker::CheckProfile(const XmlElement& profile) {
  CheckName(profile);
  if (profile.name == "participant") {
    CheckChildren(profile, ParticipantElements());
  } else if (profile.name == "topic") {
    CheckChildren(profile, TopicElements());
  } else {
    CheckChildren(profile,
                  EndpointElements(profile.name == "data_writer" || profile.name == "publisher"));
  }
}

void Checker::CheckTransports(const XmlElement& descriptors) {
  for (const XmlElement& child : descriptors.children) {
    if (child.name != "transport_descriptor") {
      AddUnknown(child, descriptors, "transport_descriptor");
      continue;
    }
    const XmlElement* type = child.Child("type");
    CheckChildren(child, TransportElements(type == nullptr ? "" : type->text));
  }
}

void Checker::CheckProfiles(const XmlElement& profiles) {
  constexpr std::string_view kProfiles =
      "participant data_writer publisher data_reader subscriber topic";
  for (const XmlElement& child : profiles.children) {
    if (WordIndex(kProfiles, child.name) >= 0) {
      CheckProfile(child);
    } else if (child.name == "transport_descriptors") {
      CheckTransports(child);
    } else if (WordIndex("types requester replier", child.name) < 0) {
      AddUnknown(child, profiles, "transport_descriptors, participant, data_writer, data_reader");
    }
  }
}

void Checker::CheckRoot(const XmlElement& root) {
  static constexpr ElementRule kLibrary[] = {
      {"intraprocess_delivery", Content::kWord, {}, "OFF USER_DATA_ONLY FULL"}};
  if (root.name == "profiles") return CheckProfiles(root);
  if (root.name != "dds") {
    Add("wrong_root", root, "is neither <dds> nor <profiles>",
        "put <profiles> in <dds xmlns=\"http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles\">");
    return;
  }
  for (const XmlElement& child : root.children) {
    if (child.name == "profiles") {
      CheckProfiles(child);
    } else if (child.name == "library_settings") {
      CheckChildren(child, kLibrary);
    } else if (child.name != "types" && child.name != "log") {
      AddUnknown(child, root, "profiles, library_settings, types, log");
    }
  }
}

}  // namespace

std::optional<std::int64_t> ParseNumber(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<bool> ParseFlag(std::string_view text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

std::optional<std::int64_t> ParseDuration(const XmlElement& element) {
  if (element.text == "DURATION_INFINITY" && element.children.empty()) return kInfinite;
  if (element.children.empty()) return std::nullopt;
  std::int64_t parts[2] = {0, 0};
  for (const XmlElement& child : element.children) {
    const bool whole = child.name == "sec";
    if (!whole && child.name != "nanosec") return std::nullopt;
    if (child.text == (whole ? "DURATION_INFINITE_SEC" : "DURATION_INFINITE_NSEC")) {
      return kInfinite;
    }
    const auto number = ParseNumber(child.text);
    const std::int64_t most = whole ? 0x7fff'ffff : kSecond - 1;
    if (!number || *number < 0 || *number > most) return std::nullopt;
    parts[whole ? 0 : 1] = *number;
  }
  if (parts[0] == 0x7fff'ffff) return kInfinite;
  return parts[0] * kSecond + parts[1];
}

void CheckSchema(const XmlElement& root, const std::string& file, Findings* findings) {
  Checker(file, findings).CheckRoot(root);
}

}  // namespace giveway::qos
