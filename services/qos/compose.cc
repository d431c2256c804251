#include "services/qos/compose.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "services/qos/compose_text.h"

namespace giveway::qos {
namespace {

// Maps merged into maps merged into maps: an alias may lead back to where it stands.
constexpr int kMostMerges = 4;

// A map's value, its own or merged into it; an undefined node if there is none.
YAML::Node ValueOf(const YAML::Node& map, const std::string& key, int merges = kMostMerges) {
  if (map.IsMap()) {
    const YAML::Node own = map[key];
    if (own) return own;
    const YAML::Node merged = map["<<"];
    if (merged && merges > 0 && merged.IsMap()) return ValueOf(merged, key, merges - 1);
    if (merged && merges > 0 && merged.IsSequence()) {
      for (const auto& one : merged) {
        const YAML::Node found = ValueOf(one, key, merges - 1);
        if (found) return found;
      }
    }
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

class ComposeReader {
 public:
  ComposeReader(const std::string& file, const std::vector<std::string>& variables)
      : file_(file), text_(variables) {}

  void Read(const YAML::Node& root);
  ComposeRead Take() { return std::move(read_); }

 private:
  Place PlaceOf(const YAML::Node& node) const { return {file_, node.Mark().line + 1}; }
  void Add(const Place& place, Severity severity, const std::string& rule,
           const std::string& subject, std::string values, std::string consequence,
           std::string remedy) {
    read_.findings.push_back({severity, rule, place, subject, std::move(values),
                              std::move(consequence), std::move(remedy)});
  }
  std::string Text(const YAML::Node& node) {
    return node && node.IsScalar() ? text_.Expanded(node.Scalar()) : "";
  }
  std::vector<std::string> Words(const YAML::Node& node);

  void ReadService(const std::string& name, const YAML::Node& node);
  void AddVariable(const std::string& name, const std::optional<std::string>& value,
                   const YAML::Node& at, ComposeService* service);
  void ReadEnvironment(const YAML::Node& node, int merges, ComposeService* service);
  void ReadMerged(const YAML::Node& merged, int merges, ComposeService* service);
  void ReadFlags(const YAML::Node& node, ComposeService* service);
  void ReadMounts(const YAML::Node& volumes, ComposeService* service);
  void ReadContainers(const YAML::Node& node, ComposeService* service);
  bool Mentions(const YAML::Node& node, std::string_view what);

  const std::string& file_;
  ComposeText text_;
  ComposeRead read_;
};

// A command as compose splits it: a list as it is, a text at its blanks.
std::vector<std::string> ComposeReader::Words(const YAML::Node& node) {
  std::vector<std::string> words;
  if (node && node.IsSequence()) {
    for (const auto& word : node) words.push_back(Text(word));
    return words;
  }
  const std::string text = Text(node);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \t\n", begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

bool ComposeReader::Mentions(const YAML::Node& node, std::string_view what) {
  const auto has = [&](const std::string& word) { return word.find(what) != std::string::npos; };
  return has(Text(ValueOf(node, "image"))) ||
         std::ranges::any_of(Words(ValueOf(node, "command")), has) ||
         std::ranges::any_of(Words(ValueOf(node, "entrypoint")), has);
}

// Without a value a variable is that of the shell, or there is none.
void ComposeReader::AddVariable(const std::string& name, const std::optional<std::string>& value,
                                const YAML::Node& at, ComposeService* service) {
  const char* const outside = value ? nullptr : text_.Variable(name);
  if (value || outside != nullptr) {
    service->environment.push_back({name, value ? *value : outside, PlaceOf(at)});
  }
}

void ComposeReader::ReadEnvironment(const YAML::Node& node, int merges, ComposeService* service) {
  if (node && node.IsSequence()) {
    for (const auto& item : node) {
      const std::string text = Text(item);
      const std::size_t equals = text.find('=');
      const bool says = equals != std::string::npos;
      AddVariable(text.substr(0, equals),
                  says ? std::optional(text.substr(equals + 1)) : std::nullopt, item, service);
    }
  } else if (node && node.IsMap()) {
    if (merges > 0) ReadMerged(node["<<"], merges - 1, service);
    for (const auto& item : node) {
      if (!item.first.IsScalar() || item.first.Scalar() == "<<") continue;
      AddVariable(item.first.Scalar(),
                  item.second.IsNull() ? std::nullopt : std::optional(Text(item.second)),
                  item.first, service);
    }
  }
}

// A map, or maps of which the first counts most: what is read last counts.
void ComposeReader::ReadMerged(const YAML::Node& merged, int merges, ComposeService* service) {
  if (!merged) return;
  if (merged.IsMap()) ReadEnvironment(merged, merges, service);
  if (!merged.IsSequence()) return;
  for (std::size_t i = merged.size(); i > 0; --i) {
    if (merged[i - 1].IsMap()) ReadEnvironment(merged[i - 1], merges, service);
  }
}

// The value of a flag in a command; nothing if it is not there.
std::optional<std::string> FlagIn(const std::vector<std::string>& words, const std::string& flag) {
  std::optional<std::string> value;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].starts_with(flag + "=")) value = words[i].substr(flag.size() + 1);
    if (words[i] == flag && i + 1 < words.size()) value = words[i + 1];
  }
  return value;
}

// A flag of the command counts more than the variable, as for the services themselves.
void ComposeReader::ReadFlags(const YAML::Node& node, ComposeService* service) {
  for (const ComposeVariable& variable : service->environment) {
    if (variable.name == "GIVEWAY_QOS") {
      service->qos = variable.value;
      service->qos_place = variable.place;
    } else if (variable.name == "GIVEWAY_DOMAIN") {
      service->domain = variable;
    }
  }
  const YAML::Node command = ValueOf(node, "command");
  const std::vector<std::string> words = Words(command);
  if (const auto qos = FlagIn(words, "--qos")) {
    service->qos = *qos;
    service->qos_place = PlaceOf(command);
  }
  if (const auto domain = FlagIn(words, "--domain")) {
    service->domain = {"--domain", *domain, PlaceOf(command)};
  }
}

void ComposeReader::ReadMounts(const YAML::Node& volumes, ComposeService* service) {
  if (!volumes || !volumes.IsSequence()) return;
  for (const auto& volume : volumes) {
    if (volume.IsMap()) {
      service->mounts.emplace_back(Text(ValueOf(volume, "source")),
                                   Text(ValueOf(volume, "target")));
      continue;
    }
    const std::string text = Text(volume);
    const std::size_t first = text.find(':');
    if (first == std::string::npos) continue;
    const std::size_t second = std::min(text.find(':', first + 1), text.size());
    service->mounts.emplace_back(text.substr(0, first), text.substr(first + 1, second - first - 1));
  }
}

void ComposeReader::ReadContainers(const YAML::Node& node, ComposeService* service) {
  const YAML::Node deploy = ValueOf(node, "deploy");
  const YAML::Node replicas = ValueOf(deploy, "replicas");
  const YAML::Node count = replicas ? replicas : ValueOf(node, "scale");
  if (!count) return;
  const std::string text = Text(count);
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), service->containers);
  if (error == std::errc() && end == text.data() + text.size() && service->containers >= 0) return;
  service->containers = 1;
  Add(PlaceOf(count), Severity::kError, "compose_count", service->name, "\"" + text + "\"",
      "It is no number of containers.", "a whole number");
}

void ComposeReader::ReadService(const std::string& name, const YAML::Node& node) {
  ComposeService service{.name = name, .place = PlaceOf(node)};
  ReadEnvironment(ValueOf(node, "environment"), kMostMerges, &service);
  const bool ours = Mentions(node, "giveway") ||
                    std::ranges::any_of(service.environment, [](const ComposeVariable& variable) {
                      return variable.name.starts_with("GIVEWAY_");
                    });
  if (!ours) return;
  const YAML::Node other = ValueOf(node, "env_file");
  if (other) {
    Add(PlaceOf(other), Severity::kWarning, "env_file_not_read", name, "env_file",
        "What it sets was not looked at.", "environment, or check with what it sets");
  }
  ReadFlags(node, &service);
  ReadMounts(ValueOf(node, "volumes"), &service);
  ReadContainers(node, &service);
  service.is_vehicle = name.find("vehicle") != std::string::npos || Mentions(node, "vehicle");
  service.host_network = Text(ValueOf(node, "network_mode")) == "host";
  service.host_ipc = Text(ValueOf(node, "ipc")) == "host";
  read_.services.push_back(std::move(service));
}

void ComposeReader::Read(const YAML::Node& root) {
  const YAML::Node services = ValueOf(root, "services");
  if (services && services.IsMap()) {
    for (const auto& item : services) {
      if (item.first.IsScalar() && item.second.IsMap())
        ReadService(item.first.Scalar(), item.second);
    }
  }
  for (const std::string& name : text_.Missing()) {
    Add({file_, 0}, Severity::kError, "compose_variable_missing", name, "is required and not set",
        "The engine refuses the file, and nothing starts.",
        "set it in this shell or in the .env next to the file");
  }
  if (!read_.services.empty()) return;
  Add({file_, 0}, Severity::kError, "no_fleet_services", "", "no service names giveway",
      "There is nothing to check.",
      "name the file that starts the fleet; its services have giveway in image, command or a "
      "variable");
}

}  // namespace

ComposeRead ReadCompose(std::string_view bytes, const std::string& file,
                        const std::vector<std::string>& variables) {
  ComposeReader reader(file, variables);
  try {
    reader.Read(YAML::Load(std::string(bytes)));
  } catch (const YAML::Exception& error) {
    return {{},
            {{Severity::kError,
              "malformed_yaml",
              {file, error.mark.is_null() ? 0 : error.mark.line + 1},
              "",
              error.msg,
              "The engine refuses the file, and nothing starts.",
              "correct the YAML"}}};
  }
  return reader.Take();
}

std::string HostPath(const ComposeService& service, const std::string& inside) {
  for (const auto& [host, target] : service.mounts) {
    if (inside == target) return host;
    const std::string folder = target.ends_with('/') ? target : target + "/";
    if (inside.starts_with(folder)) return host + "/" + inside.substr(folder.size());
  }
  return "";
}

}  // namespace giveway::qos
