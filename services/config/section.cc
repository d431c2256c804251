#include "services/config/section.h"

#include <fmt/format.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/config/problem.h"
#include "services/config/text_parse.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"

namespace giveway {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

constexpr int kMaxDepth = 32;
constexpr std::size_t kShownOfValue = 60;  // of a value

const FieldDescriptor* Find(const Message& message, std::string_view field) {
  const FieldDescriptor* found = message.GetDescriptor()->FindFieldByName(std::string(field));
  GIVEWAY_CHECK(found != nullptr, message.GetTypeName(), field);
  return found;
}

std::string ElementName(std::string_view field, int index) {
  return index < 0 ? std::string(field) : fmt::format("{}[{}]", field, index);
}

// Offset of a position the parser counted by lines and columns; it widens tabs to 8 columns.
std::size_t Offset(const std::string& text, TextFormat::ParseLocation at) {
  std::size_t offset = 0;
  for (int line = 0; line < at.line && offset < text.size(); ++offset) {
    if (text[offset] == '\n') ++line;
  }
  for (int column = 0; column < at.column && offset < text.size(); ++offset) {
    column += text[offset] == '\t' ? 8 - column % 8 : 1;
  }
  return offset;
}

// `name: value;` without the name and the separator, cut to fit a line.
std::string ValueOf(std::string written) {
  const std::size_t colon = written.find_first_of(":{<");
  if (colon == std::string::npos) return "";
  written.erase(0, written[colon] == ':' ? colon + 1 : colon);
  std::replace(written.begin(), written.end(), '\n', ' ');
  const std::size_t first = written.find_first_not_of(" \t\r");
  const std::size_t last = written.find_last_not_of(" \t\r,;");
  if (first == std::string::npos || last == std::string::npos || last < first) return "";
  return Shortened(written.substr(first, last - first + 1), kShownOfValue);
}

// Hears what the parser says and keeps it as problems.
class Listener : public google::protobuf::io::ErrorCollector {
 public:
  Listener(const std::string& file, const std::string& text) : file_(file), text_(text) {}
  void AddError(int line, int column, const std::string& message) override {
    problems_.Add(ParserProblem(file_, text_, line, column, message, false));
  }
  void AddWarning(int line, int column, const std::string& message) override {
    if (problems_.Full()) return problems_.Add({});
    problems_.Add(ParserProblem(file_, text_, line, column, message, true));
  }
  const ProblemList& Problems() const { return problems_; }

 private:
  const std::string& file_;
  const std::string& text_;
  ProblemList problems_;
};

}  // namespace

struct Section::File {
  std::string name;
  std::string text;
  std::unique_ptr<Message> message;
  TextFormat::ParseInfoTree tree;
  ProblemList problems;
};

struct Section::Node {
  std::shared_ptr<File> file;
  const Message* message;
  const TextFormat::ParseInfoTree* tree;
  std::string path;
  int line;

  TextFormat::ParseLocationRange Where(const FieldDescriptor* field, int index) const {
    if (tree == nullptr) return {};
    if (!field->is_repeated()) return tree->GetLocationRange(field, -1);
    const auto range = tree->GetLocationRange(field, std::max(index, 0));
    // The parser notes a list in brackets once, at its first element.
    return range.start.line >= 0 ? range : tree->GetLocationRange(field, 0);
  }
};

std::string Describe(const Allowed& allowed) {
  const std::string unit = allowed.unit.empty() ? "" : fmt::format(" {}", allowed.unit);
  return allowed.above_low
             ? fmt::format("above {} and at most {}{}", allowed.low, allowed.high, unit)
             : fmt::format("between {} and {}{}", allowed.low, allowed.high, unit);
}

Section ParseText(const std::string& file, const std::string& text, const Message& prototype) {
  auto shared = std::make_shared<Section::File>();
  shared->name = file;
  shared->text = text;
  shared->message.reset(prototype.New());
  Listener listener(file, text);
  TextFormat::Parser parser;
  parser.AllowUnknownField(true);
  parser.AllowUnknownExtension(true);
  parser.SetRecursionLimit(kMaxDepth);
  parser.RecordErrorsTo(&listener);
  parser.WriteLocationsTo(&shared->tree);
  if (!parser.ParseFromString(text, shared->message.get()))
    throw InputError(listener.Problems().Sorted());
  shared->problems = listener.Problems();
  return Section(std::make_shared<Section::Node>(
      Section::Node{shared, shared->message.get(), &shared->tree, "", 1}));
}

bool Section::Has(std::string_view field) const {
  const Message& message = *node_->message;
  const FieldDescriptor* f = Find(message, field);
  return f->is_repeated() ? message.GetReflection()->FieldSize(message, f) > 0
                          : message.GetReflection()->HasField(message, f);
}

int Section::Line() const { return node_->line; }

int Section::Count(std::string_view field) const {
  const Message& message = *node_->message;
  return message.GetReflection()->FieldSize(message, Find(message, field));
}

double Section::CheckedNumber(std::string_view field, const Allowed& allowed, int index) const {
  const Message& message = *node_->message;
  const FieldDescriptor* f = Find(message, field);
  const auto* reflection = message.GetReflection();
  const bool whole = f->cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
  double value = 0;
  if (index < 0) {
    value = whole ? reflection->GetUInt32(message, f) : reflection->GetDouble(message, f);
  } else {
    value = whole ? reflection->GetRepeatedUInt32(message, f, index)
                  : reflection->GetRepeatedDouble(message, f, index);
  }
  if (allowed.Contains(value)) return value;  // never true of nan
  AddError(field,
           fmt::format("{}must be {}", std::isfinite(value) ? "" : "is not a finite number; ",
                       Describe(allowed)),
           "write a number in that range", index);
  return kUnusable;
}

double Section::Number(std::string_view field, const Allowed& allowed) const {
  if (Has(field)) return CheckedNumber(field, allowed, -1);
  AddMissingError(field, fmt::format("write {}: with a number {}", field, Describe(allowed)));
  return kUnusable;
}

double Section::NumberOr(double fallback, std::string_view field, const Allowed& allowed) const {
  return Has(field) ? CheckedNumber(field, allowed, -1) : fallback;
}

std::uint32_t Section::Uint(std::string_view field, const Allowed& allowed) const {
  const double value = Number(field, allowed);
  return std::isnan(value) ? 0 : static_cast<std::uint32_t>(value);
}

std::uint32_t Section::UintOr(std::uint32_t fallback, std::string_view field,
                              const Allowed& allowed) const {
  return Has(field) ? Uint(field, allowed) : fallback;
}

bool Section::FlagOr(bool fallback, std::string_view field) const {
  const Message& message = *node_->message;
  return Has(field) ? message.GetReflection()->GetBool(message, Find(message, field)) : fallback;
}

std::vector<double> Section::Numbers(std::string_view field, const Allowed& allowed,
                                     int most) const {
  const int size = Count(field);
  std::vector<double> numbers;
  if (size > most) {
    AddError(field, fmt::format("has {} values; at most {} are allowed", size, most),
             "leave some out");
    return numbers;
  }
  for (int i = 0; i < size; ++i) numbers.push_back(CheckedNumber(field, allowed, i));
  return numbers;
}

std::string Section::Text(std::string_view field) const {
  return node_->message->GetReflection()->GetString(*node_->message, Find(*node_->message, field));
}

std::vector<std::string> Section::Texts(std::string_view field) const {
  const Message& message = *node_->message;
  const FieldDescriptor* f = Find(message, field);
  std::vector<std::string> texts;
  for (int i = 0; i < Count(field); ++i) {
    texts.push_back(message.GetReflection()->GetRepeatedString(message, f, i));
  }
  return texts;
}

std::optional<int> Section::Enum(std::string_view field) const {
  if (!Has(field)) return std::nullopt;
  const FieldDescriptor* f = Find(*node_->message, field);
  const int value = node_->message->GetReflection()->GetEnumValue(*node_->message, f);
  if (f->enum_type()->FindValueByNumber(value) != nullptr) return value;
  std::string names;
  for (int i = 0; i < f->enum_type()->value_count(); ++i) {
    names += (i == 0 ? "" : ", ") + f->enum_type()->value(i)->name();
  }
  AddError(field, "must be one of " + names, "write one of these names");
  return std::nullopt;
}

Section Section::Child(std::string_view field, int index) const {
  const Message& message = *node_->message;
  const FieldDescriptor* f = Find(message, field);
  const auto* reflection = message.GetReflection();
  const int line = node_->Where(f, index).start.line + 1;
  Node child{node_->file,
             index < 0 ? &reflection->GetMessage(message, f)
                       : &reflection->GetRepeatedMessage(message, f, index),
             node_->tree == nullptr ? nullptr : node_->tree->GetTreeForNested(f, index),
             node_->path + (node_->path.empty() ? "" : ".") + ElementName(field, index),
             line > 0 ? line : node_->line};
  return Section(std::make_shared<const Node>(std::move(child)));
}

std::optional<Section> Section::Child(std::string_view field) const {
  if (!Has(field)) return std::nullopt;
  return Child(field, -1);
}

std::optional<Section> Section::RequiredChild(std::string_view field) const {
  if (!Has(field)) AddMissingError(field, fmt::format("write {} {{ ... }}", field));
  return Child(field);
}

std::vector<Section> Section::Children(std::string_view field) const {
  const int size = Count(field);
  std::vector<Section> sections;
  for (int i = 0; i < size; ++i) sections.push_back(Child(field, i));
  return sections;
}

void Section::AddError(std::string_view field, std::string message, std::string remedy,
                       int index) const {
  File& file = *node_->file;
  if (file.problems.Full()) return file.problems.Add({});
  Problem problem{file.name, node_->line, node_->path, "", std::move(message), std::move(remedy)};
  if (!field.empty()) {
    problem.field += (node_->path.empty() ? "" : ".") + ElementName(field, index);
    const auto where = node_->Where(Find(*node_->message, field), index);
    if (where.start.line >= 0) {
      const std::size_t begin = Offset(file.text, where.start);
      const std::size_t end = std::max(begin, Offset(file.text, where.end));
      problem.line = where.start.line + 1;
      problem.value = ValueOf(file.text.substr(begin, end - begin));
    }
  }
  file.problems.Add(std::move(problem));
}

void Section::AddMissingError(std::string_view field, std::string remedy) const {
  AddError(field, "is required and missing", std::move(remedy));
}

std::vector<Problem> Section::Problems() const { return node_->file->problems.Sorted(); }

}  // namespace giveway
