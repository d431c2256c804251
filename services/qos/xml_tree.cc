#include "services/qos/xml_tree.h"

#include <tinyxml2.h>

#include <algorithm>

namespace giveway::qos {
namespace {

constexpr char kNotLoaded[] = "The library loads nothing of the file, and no process starts.";
// That of the parser is 100 on Debian 12, 500 on Debian 13.
constexpr int kMaxDepth = 100;
constexpr char kTooDeep[] = "elements nest deeper than 100";
constexpr char kCopyDefault[] = "start from a copy of config/qos/default.xml";

Finding Unusable(const std::string& rule, const std::string& file, int line, std::string values,
                 std::string remedy) {
  return {Severity::kError,  rule,       {file, line},     "",
          std::move(values), kNotLoaded, std::move(remedy)};
}

std::string Reason(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed by its own name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is malformed, or given twice";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment does not end";
    case tinyxml2::XML_ERROR_PARSING:
      return "an element does not end";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return kTooDeep;
    default:
      return "this is not XML";
  }
}

// Where elements nest too deep; nothing if they do not.
const tinyxml2::XMLElement* TooDeep(const tinyxml2::XMLElement& element, int depth) {
  if (depth >= kMaxDepth) return &element;
  const auto* child = element.FirstChildElement();
  for (; child != nullptr; child = child->NextSiblingElement()) {
    if (const auto* found = TooDeep(*child, depth + 1)) return found;
  }
  return nullptr;
}

// <!DOCTYPE ...> or <!ENTITY ...> before or after the root; null if there is none.
const tinyxml2::XMLUnknown* DocumentType(const tinyxml2::XMLDocument& document) {
  for (const auto* node = document.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (const auto* unknown = node->ToUnknown()) return unknown;
  }
  return nullptr;
}

std::string Shortened(std::string_view text) {
  constexpr std::size_t kShown = 24;
  return std::string(text.substr(0, kShown)) + (text.size() > kShown ? "…" : "");
}

XmlElement Copied(const tinyxml2::XMLElement& from, std::size_t* budget) {
  XmlElement to;
  to.name = from.Name();
  to.line = from.GetLineNum();
  if (const char* text = from.GetText()) to.text = text;
  for (const auto* at = from.FirstAttribute(); at != nullptr; at = at->Next()) {
    to.attributes.push_back({at->Name(), at->Value()});
  }
  const auto* child = from.FirstChildElement();
  for (; child != nullptr && *budget > 0; child = child->NextSiblingElement()) {
    --*budget;
    to.children.push_back(Copied(*child, budget));
  }
  return to;
}

// What is no XML before anyone parses it.
std::optional<Finding> Refused(std::string_view bytes, const std::string& file) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  if (std::ranges::all_of(bytes, blank)) {
    return Unusable("empty_file", file, 0, "holds nothing", kCopyDefault);
  }
  if (bytes.size() > kMaxFileBytes) {
    return Unusable("file_too_large", file, 0,
                    std::to_string(bytes.size()) + " bytes; at most " +
                        std::to_string(kMaxFileBytes) + " are read",
                    "check that this is the file you meant");
  }
  if (bytes.find('\0') != std::string_view::npos) {
    return Unusable("not_text", file, 0, "holds binary data",
                    "check that this is the file you meant");
  }
  return std::nullopt;
}

}  // namespace

const XmlElement* XmlElement::Child(std::string_view child_name) const {
  const auto found = std::find_if(children.rbegin(), children.rend(), [&](const XmlElement& child) {
    return child.name == child_name;
  });
  return found == children.rend() ? nullptr : &*found;
}

const XmlElement* XmlElement::FirstChild(std::string_view child_name) const {
  const auto found = std::ranges::find(children, child_name, &XmlElement::name);
  return found == children.end() ? nullptr : &*found;
}

const XmlElement* XmlElement::Descendant(std::string_view path) const {
  const std::size_t slash = path.find('/');
  const XmlElement* child = Child(path.substr(0, slash));
  if (child == nullptr || slash == std::string_view::npos) return child;
  return child->Descendant(path.substr(slash + 1));
}

std::string XmlElement::Attribute(std::string_view attribute_name) const {
  for (const XmlAttribute& attribute : attributes) {
    if (attribute.name == attribute_name) return attribute.value;
  }
  return {};
}

XmlRead ReadXml(std::string_view bytes, const std::string& file) {
  if (const auto refused = Refused(bytes, file)) return {std::nullopt, {*refused}};
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) {
    return {std::nullopt,
            {Unusable("malformed_xml", file, document.ErrorLineNum(), Reason(document),
                      "correct the XML here or just before; xmllint --noout FILE says more")}};
  }
  if (const auto* type = DocumentType(document)) {
    return {std::nullopt,
            {Unusable("document_type", file, type->GetLineNum(),
                      "declares a document type or entities, <!" + Shortened(type->Value()) + ">",
                      "remove it: entities are not expanded, and a set needs none")}};
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) {
    return {std::nullopt, {Unusable("empty_file", file, 0, "has no element", kCopyDefault)}};
  }
  if (const auto* deep = TooDeep(*root, 1)) {
    return {std::nullopt,
            {Unusable("malformed_xml", file, deep->GetLineNum(), kTooDeep, kCopyDefault)}};
  }
  std::size_t budget = kMaxElements;
  XmlElement tree = Copied(*root, &budget);
  if (budget > 0) return {std::move(tree), {}};
  return {std::nullopt,
          {Unusable("file_too_large", file, 0,
                    "more than " + std::to_string(kMaxElements) + " elements",
                    "check that this is the file you meant")}};
}

}  // namespace giveway::qos
