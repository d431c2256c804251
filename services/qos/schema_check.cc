#include "services/qos/schema_check.h"

#include <algorithm>
#include <optional>
#include <set>

#include "services/qos/policy.h"
#include "services/qos/profile_set.h"
#include "services/qos/schema.h"
#include "services/qos/xml_value.h"

namespace giveway::qos {
namespace {

constexpr char kRefused[] = "The library refuses the whole file, and no process starts.";
constexpr char kUnknown[] =
    "Fast DDS refuses the whole file, and no process starts; what 3.1 alone knows stops every "
    "process with 2.9.";
constexpr char kDropped[] =
    "The library reads the digits it finds first, drops the rest silently, and runs with "
    "that.";
constexpr char kHangs[] =
    "The library loops for ever on such a duration: the process that makes the endpoint hangs, and "
    "SIGTERM does not end it.";
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
  void AddSecondProfiles(const XmlElement& second, const XmlElement& first);
  void CheckProfiles(const XmlElement& profiles);
  void CheckProfile(const XmlElement& profile);
  void CheckTransports(const XmlElement& descriptors);
  void CheckChildren(const XmlElement& parent, std::span<const ElementRule> rules);
  void CheckElement(const XmlElement& element, const ElementRule& rule);
  void CheckText(const XmlElement& element, const ElementRule& rule);
  void CheckNumber(const XmlElement& element, Content content);
  bool IsExact(const XmlElement& element, const Number& number);
  void CheckDuration(const XmlElement& element);
  void CheckDurationPart(const XmlElement& part);
  void CheckName(const XmlElement& profile);
  void AddUnknown(const XmlElement& element, const XmlElement& parent, std::string known);
  void AddRepeated(const XmlElement& element, const XmlElement& parent);
  void AddWrong(const XmlElement& element, const std::string& must_be);
  void AddDoor(const XmlElement& element);
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

void Checker::AddRepeated(const XmlElement& element, const XmlElement& parent) {
  Add("repeated_element", element, "stands twice in <" + parent.name + ">",
      "keep the one that is meant", Severity::kError,
      "The library takes the last of them, or refuses the whole file.");
}

void Checker::AddWrong(const XmlElement& element, const std::string& must_be) {
  Add("wrong_value", element, Quoted(element.text) + " is not " + must_be, "write " + must_be);
}

// False, and a finding, where the library takes another number than a person reads.
bool Checker::IsExact(const XmlElement& element, const Number& number) {
  if (number.exact) return true;
  Add("number_cut_off", element,
      Quoted(element.text) + " is taken for " + std::to_string(number.value),
      "write the number alone, within 32 bits", Severity::kError, kDropped);
  return false;
}

void Checker::CheckDurationPart(const XmlElement& part) {
  if (IsInfinite(part.text)) return;
  const bool whole = part.name == "sec";
  const auto number = ReadNumber(part.text, whole ? NumberKind::kSigned : NumberKind::kUnsigned);
  if (!number) {
    AddWrong(part, "a number");
  } else if (number->value < 0 || (!whole && number->value > 999'999'999)) {
    Add("duration_out_of_range", part, Quoted(part.text),
        whole ? "write seconds from 0 to 2147483647, or DURATION_INFINITY"
              : "write nanoseconds from 0 to 999999999, and whole seconds in <sec>",
        Severity::kError, kHangs);
  } else {
    IsExact(part, *number);
  }
}

void Checker::CheckDuration(const XmlElement& element) {
  if (element.children.empty() && IsInfinite(element.text)) return;
  if (element.Child("sec") == nullptr && element.Child("nanosec") == nullptr) {
    Add("wrong_value", element, "is not a duration",
        "write <sec> from 0 to 2147483647 and <nanosec> from 0 to 999999999, or DURATION_INFINITY");
  }
  if (!element.children.empty() && IsInfinite(element.text)) {
    Add("wrong_value", element, Quoted(element.text) + " and parts of a duration",
        "write one of the two");
  }
  const bool is_infinite = ReadDuration(element) == kInfinite;
  std::set<std::string_view> seen;
  for (const XmlElement& child : element.children) {
    if (child.name != "sec" && child.name != "nanosec") {
      AddUnknown(child, element, "sec, nanosec");
    } else if (!seen.insert(child.name).second) {
      AddRepeated(child, element);
    } else if (!is_infinite) {
      CheckDurationPart(child);
    }
  }
}

void Checker::CheckNumber(const XmlElement& element, Content content) {
  struct Range {
    std::int64_t least, most;
    const char* words;
  };
  const bool is_unsigned = content == Content::kUnsigned || content == Content::kPort;
  const auto number =
      ReadNumber(element.text, is_unsigned ? NumberKind::kUnsigned : NumberKind::kSigned);
  Range range{-0x8000'0000LL, 0xffff'ffff, "a number"};
  if (content == Content::kPort) range = {0, 0xffff, "a number from 0 to 65535"};
  if (content == Content::kByte) range = {0, 0xff, "a number from 0 to 255"};
  if (!number || (number->exact && (number->value < range.least || number->value > range.most))) {
    AddWrong(element, range.words);
  } else {
    IsExact(element, *number);
  }
}

void Checker::CheckText(const XmlElement& element, const ElementRule& rule) {
  switch (rule.content) {
    case Content::kWord:
      if (WordIndex(rule.words, element.text) < 0) {
        AddWrong(element, "one of " + std::string(rule.words));
      }
      break;
    case Content::kUnsigned:
    case Content::kPort:
    case Content::kInteger:
    case Content::kByte:
      CheckNumber(element, rule.content);
      break;
    case Content::kFlag:
      if (!ReadFlag(element.text)) AddWrong(element, "true or false");
      break;
    case Content::kText:
      if (element.text.empty()) AddWrong(element, "a text");
      break;
    default:
      return;
  }
  for (const XmlElement& child : element.children) AddUnknown(child, element, "nothing");
}

void Checker::AddDoor(const XmlElement& element) {
  Add("beyond_qos", element, "is no QoS", "remove it, unless the fleet cannot do without it",
      Severity::kWarning,
      "The library writes or opens files for it, or loads parts that QoS does not need; an order "
      "by "
      "fleetctl qos apply may not bring it.");
}

void Checker::CheckElement(const XmlElement& element, const ElementRule& rule) {
  if (rule.content == Content::kOpaque) return;
  if (rule.content == Content::kDoor) return AddDoor(element);
  if (rule.gone_in_3) {
    Add("removed_element", element, "is an element of Fast DDS 2.9 alone", "remove it",
        Severity::kError,
        "Every process with Fast DDS 3 refuses the whole file, and does not start.");
  }
  if (rule.content == Content::kNoEffect) {
    Add("no_effect", element, "is accepted by Fast DDS and not looked at",
        "remove it: a reader of the file believes it holds", Severity::kWarning,
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
      AddRepeated(child, parent);
    }
    CheckElement(child, *rule);
  }
}

void Checker::CheckName(const XmlElement& profile) {
  if (profile.Attribute("profile_name").empty()) {
    Add("unnamed_profile", profile, "has no attribute profile_name",
        "name it; the services take profiles by name", Severity::kError,
        "The library refuses the whole file, or keeps a profile that cannot be asked for.");
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
  const XmlElement* const read = ProfilesOf(root);
  for (const XmlElement& child : root.children) {
    if (child.name == "profiles") {
      if (&child != read) AddSecondProfiles(child, *read);
      CheckProfiles(child);
    } else if (child.name == "library_settings") {
      CheckChildren(child, kLibrary);
    } else if (child.name == "log") {
      AddDoor(child);
    } else if (child.name != "types") {
      AddUnknown(child, root, "profiles, library_settings, types, log");
    }
  }
}

void Checker::AddSecondProfiles(const XmlElement& second, const XmlElement& first) {
  Add("second_profiles", second, "is a second one after that of line " + std::to_string(first.line),
      "move what is in it to the first", Severity::kError,
      "The library reads the first <profiles> and drops every other silently.");
}

}  // namespace

void CheckSchema(const XmlElement& root, const std::string& file, Findings* findings) {
  Checker(file, findings).CheckRoot(root);
}

}  // namespace giveway::qos
