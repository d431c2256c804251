#include "services/qos/profile_edit.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "services/qos/xml_tree.h"
#include "services/types/check.h"

namespace giveway::qos {
namespace {

// Where an element stands in the text: "<a>", what is inside, "</a>". Empty ones, "<a/>", have
// their inside at their end.
struct Extent {
  std::size_t begin = 0;
  std::size_t inner_begin = 0;
  std::size_t inner_end = 0;
  std::size_t end = 0;
};

// One tag: an element's first or last, or one that is both.
struct Tag {
  std::size_t begin = 0;
  std::size_t end = 0;
  bool closes = false;
  bool empty = false;
};

// Behind the '>' that ends the tag; one in quotes does not.
std::size_t EndOfTag(std::string_view text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '>') {
      return i + 1;
    }
  }
  return text.size();
}

// What is neither an element nor text, and may hold anything.
std::size_t EndOfOther(std::string_view text, std::size_t begin) {
  const auto behind = [&](std::string_view last) {
    const std::size_t found = text.find(last, begin);
    return found == std::string_view::npos ? text.size() : found + last.size();
  };
  const std::string_view rest = text.substr(begin);
  if (rest.starts_with("<!--")) return behind("-->");
  if (rest.starts_with("<![CDATA[")) return behind("]]>");
  if (rest.starts_with("<?")) return behind("?>");
  return behind(">");
}

// The next tag at or after `from`; nothing at the end. The text is known to be well-formed.
std::optional<Tag> NextTag(std::string_view text, std::size_t from) {
  std::size_t begin = text.find('<', from);
  while (begin != std::string_view::npos && begin + 1 < text.size() &&
         (text[begin + 1] == '!' || text[begin + 1] == '?')) {
    begin = text.find('<', EndOfOther(text, begin));
  }
  if (begin == std::string_view::npos || begin + 1 >= text.size()) return std::nullopt;
  const std::size_t end = EndOfTag(text, begin);
  return Tag{begin, end, text[begin + 1] == '/', text[end - 2] == '/'};
}

// The elements directly inside [from, to).
std::vector<Extent> ElementsIn(std::string_view text, std::size_t from, std::size_t to) {
  std::vector<Extent> elements;
  int depth = 0;
  for (auto tag = NextTag(text, from); tag && tag->end <= to; tag = NextTag(text, tag->end)) {
    if (depth == 0 && !tag->closes) elements.push_back({tag->begin, tag->end, tag->end, tag->end});
    if (!tag->empty) depth += tag->closes ? -1 : 1;
    if (depth == 0 && tag->closes) {
      elements.back().inner_end = tag->begin;
      elements.back().end = tag->end;
    }
  }
  return elements;
}

bool Owns(Owner owner, std::string_view element) {
  switch (owner) {
    case Owner::kParticipant:
      return element == "participant";
    case Owner::kWriter:
      return element == "data_writer" || element == "publisher";
    case Owner::kReader:
      return element == "data_reader" || element == "subscriber";
  }
  return false;
}

// An element of the tree, and where it stands: children of both come in the same order.
struct Spot {
  const XmlElement* element = nullptr;
  Extent extent;
};

// The last child that fits, as the library's later elements win.
template <typename Fits>
std::optional<Spot> LastChild(std::string_view text, const Spot& parent, Fits&& fits) {
  const auto extents = ElementsIn(text, parent.extent.inner_begin, parent.extent.inner_end);
  for (std::size_t i = parent.element->children.size(); i-- > 0;) {
    if (fits(parent.element->children[i])) return Spot{&parent.element->children[i], extents.at(i)};
  }
  return std::nullopt;
}

std::optional<Spot> FindProfile(std::string_view text, const XmlElement& root,
                                const ProfileEdit& edit) {
  const Spot top{&root, ElementsIn(text, 0, text.size()).front()};
  const auto is_it = [&](const XmlElement& element) {
    return Owns(edit.owner, element.name) && element.Attribute("profile_name") == edit.profile;
  };
  if (root.name == "profiles") return LastChild(text, top, is_it);
  const auto profiles =
      LastChild(text, top, [](const XmlElement& child) { return child.name == "profiles"; });
  return profiles ? LastChild(text, *profiles, is_it) : std::nullopt;
}

std::string NestedXml(std::string_view path, const std::string& value) {
  const std::size_t slash = path.find('/');
  const std::string name(path.substr(0, slash));
  const std::string inside =
      slash == std::string_view::npos ? value : NestedXml(path.substr(slash + 1), value);
  return "<" + name + ">" + inside + "</" + name + ">";
}

// Puts `xml` last into the element, on a line of its own where its end tag has one.
void Append(std::string* text, const Spot& parent, const std::string& xml) {
  const Extent& at = parent.extent;
  if (at.inner_begin == at.end) {  // "<a/>"
    text->replace(at.end - 2, 2, ">" + xml + "</" + parent.element->name + ">");
    return;
  }
  const std::size_t line = text->rfind('\n', at.inner_end - 1) + 1;
  const std::string indent = text->substr(line, at.inner_end - line);
  if (line > at.inner_begin && indent.find_first_not_of(" \t") == std::string::npos) {
    text->insert(line, indent + "  " + xml + "\n");
  } else {
    text->insert(at.inner_end, xml);
  }
}

// Sets what the element at `path` below `spot` says, and makes it where it is missing.
void Set(std::string* text, Spot spot, std::string_view path, const std::string& value) {
  for (;;) {
    const std::size_t slash = path.find('/');
    const std::string_view name = path.substr(0, slash);
    const auto child =
        LastChild(*text, spot, [&](const XmlElement& element) { return element.name == name; });
    if (!child) return Append(text, spot, NestedXml(path, value));
    spot = *child;
    if (slash == std::string_view::npos) break;
    path.remove_prefix(slash + 1);
  }
  const Extent& at = spot.extent;
  if (at.inner_begin == at.end) return Append(text, spot, value);
  text->replace(at.inner_begin, at.inner_end - at.inner_begin, value);
}

struct Leaf {
  std::string path;
  std::string text;
};

// `now` is the element there is; null if there is none.
std::vector<Leaf> LeavesOf(const ProfileEdit& edit, const XmlElement* now) {
  const PolicyInfo& info = Info(edit.policy);
  const std::string path(info.path);
  if (info.shape != Shape::kDuration) return {{path, Text(edit.policy, edit.value)}};
  GIVEWAY_CHECK(edit.value >= 0, edit.profile);
  if (edit.value == kInfinite) return {{path, "DURATION_INFINITY"}};
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::string seconds = std::to_string(edit.value / kSecond);
  const std::string nanoseconds = std::to_string(edit.value % kSecond);
  if (now != nullptr && now->children.empty()) {
    return {{path, "<sec>" + seconds + "</sec><nanosec>" + nanoseconds + "</nanosec>"}};
  }
  return {{path + "/sec", seconds}, {path + "/nanosec", nanoseconds}};
}

}  // namespace

EditedProfiles Edit(std::string bytes, const std::string& file,
                    const std::vector<ProfileEdit>& edits) {
  for (const ProfileEdit& edit : edits) {
    const XmlRead before = ReadXml(bytes, file);
    const auto there = before.root ? FindProfile(bytes, *before.root, edit) : std::nullopt;
    const XmlElement* const now =
        there ? there->element->Descendant(Info(edit.policy).path) : nullptr;
    for (const Leaf& leaf : LeavesOf(edit, now)) {
      // Read again each time: an edit moves all that stands behind it.
      const XmlRead read = ReadXml(bytes, file);
      if (!read.root) return {"", read.findings};
      const auto profile = FindProfile(bytes, *read.root, edit);
      if (!profile) {
        return {"",
                {{Severity::kError,
                  "missing_profile",
                  {file, 0},
                  edit.profile,
                  "is not in the file",
                  "There is nothing to change.",
                  "copy the profile from config/qos/default.xml"}}};
      }
      Set(&bytes, *profile, leaf.path, leaf.text);
    }
  }
  return {std::move(bytes), {}};
}

std::string WithComment(std::string bytes, std::string comment) {
  // Two hyphens would end it.
  for (std::size_t at = 0; (at = comment.find("--", at)) != std::string::npos;) {
    comment.replace(at, 2, "-");
  }
  constexpr std::string_view kBlanksAndMark = " \t\r\n\xEF\xBB\xBF";
  constexpr std::string_view kDeclaration = "<?xml";
  const std::size_t first = std::min(bytes.find_first_not_of(kBlanksAndMark), bytes.size());
  const bool declares = bytes.compare(first, kDeclaration.size(), kDeclaration) == 0;
  const std::size_t at = declares ? EndOfOther(bytes, first) : first;
  bytes.insert(at, (declares ? "\n" : "") + ("<!-- " + comment + " -->") + (declares ? "" : "\n"));
  return bytes;
}

}  // namespace giveway::qos
