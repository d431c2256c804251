#include "services/qos/compose.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace giveway::qos {
namespace {

// Expansions of one text: a variable whose value names itself would never end.
constexpr int kMostExpansions = 100;

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
      : file_(file), variables_(variables) {}

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
  std::string Expanded(std::string text) const;
  std::optional<std::string> Variable(const std::string& name) const;
  std::string Text(const YAML::Node& node) const {
    return node && node.IsScalar() ? Expanded(node.Scalar()) : "";
  }
  std::vector<std::string> Words(const YAML::Node& node) const;

  void ReadService(const std::string& name, const YAML::Node& node);
  void ReadEnvironment(const YAML::Node& node, int merges, ComposeService* service) const;
  void ReadQos(const YAML::Node& node, ComposeService* service) const;
  void ReadMounts(const YAML::Node& volumes, ComposeService* service) const;
  void ReadContainers(const YAML::Node& node, ComposeService* service);
  bool Mentions(const YAML::Node& node, std::string_view what) const;

  const std::string& file_;
  const std::vector<std::string>& variables_;
  ComposeRead read_;
};

std::optional<std::string> ComposeReader::Variable(const std::string& name) const {
  for (const std::string& variable : variables_) {
    if (variable.starts_with(name + "=")) return variable.substr(name.size() + 1);
  }
  return std::nullopt;
}

// ${NAME}, ${NAME:-otherwise} and ${NAME-otherwise}; anything else stays as it is.
std::string ComposeReader::Expanded(std::string text) const {
  std::size_t from = 0;
  for (int i = 0; i < kMostExpansions; ++i) {
    const std::size_t begin = text.find("${", from);
    const std::size_t end = begin == std::string::npos ? begin : text.find('}', begin);
    if (end == std::string::npos) break;
    const std::string inner = text.substr(begin + 2, end - begin - 2);
    const std::size_t dash = inner.find('-');
    const bool or_empty = dash != std::string::npos && dash > 0 && inner[dash - 1] == ':';
    const std::string name = inner.substr(0, or_empty ? dash - 1 : dash);
    std::string value = Variable(name).value_or("");
    if (value.empty() && dash != std::string::npos) value = inner.substr(dash + 1);
    text.replace(begin, end - begin + 1, value);
    from = begin + value.size();
  }
  return text;
}

// A command as compose splits it: a list as it is, a text at its blanks.
std::vector<std::string> ComposeReader::Words(const YAML::Node& node) const {
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

bool ComposeReader::Mentions(const YAML::Node& node, std::string_view what) const {
  const auto has = [&](const std::string& word) { return word.find(what) != std::string::npos; };
  return has(Text(ValueOf(node, "image"))) ||
         std::ranges::any_of(Words(ValueOf(node, "command")), has) ||
         std::ranges::any_of(Words(ValueOf(node, "entrypoint")), has);
}

void ComposeReader::ReadEnvironment(const YAML::Node& node, int merges,
                                    ComposeService* service) const {
  const auto add = [&](const std::string& name, const std::string& value, const YAML::Node& at) {
    service->environment.push_back({name, value, PlaceOf(at)});
  };
  if (node && node.IsSequence()) {
    for (const auto& item : node) {
      const std::string text = Text(item);
      const std::size_t equals = std::min(text.find('='), text.size());
      const std::string name = text.substr(0, equals);
      add(name, equals < text.size() ? text.substr(equals + 1) : Variable(name).value_or(""), item);
    }
  } else if (node && node.IsMap()) {
    const YAML::Node merged = node["<<"];
    if (merged && merges > 0) ReadEnvironment(merged, merges - 1, service);
    for (const auto& item : node) {
      if (item.first.IsScalar() && item.first.Scalar() != "<<")
        add(item.first.Scalar(), Text(item.second), item.first);
    }
  }
}

// A flag of the command counts more than the variable, as for the services themselves.
void ComposeReader::ReadQos(const YAML::Node& node, ComposeService* service) const {
  for (const ComposeVariable& variable : service->environment) {
    if (variable.name != "GIVEWAY_QOS") continue;
    service->qos = variable.value;
    service->qos_place = variable.place;
  }
  const YAML::Node command = ValueOf(node, "command");
  const std::vector<std::string> words = Words(command);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool joined = words[i].starts_with("--qos=");
    if (!joined && (words[i] != "--qos" || i + 1 == words.size())) continue;
    service->qos = joined ? words[i].substr(6) : words[i + 1];
    service->qos_place = PlaceOf(command);
  }
}

void ComposeReader::ReadMounts(const YAML::Node& volumes, ComposeService* service) const {
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
  ReadQos(node, &service);
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
