# Counts the words of words.txt. Rows: "text|name | pattern | instead | most". A "text" row is looked
# for in what people read: comments, string literals, Markdown, prose of scripts; a "name" row in all
# of a source. The first file is the table, the others are the sources.
# Prints "pattern <tab> count <tab> most <tab> instead" for each row; with -v show=PATTERN the places.
BEGIN { FS = "\n" }
FNR == 1 { file++ }
file == 1 {
  if ($0 ~ /^#/ || $0 !~ /\|/) next
  split($0, cell, / *\| */)
  kind[++rows] = cell[1]; pattern[rows] = cell[2]; instead[rows] = cell[3]; most[rows] = cell[4]
  expression[rows] = cell[2]
  gsub(/ \/ /, "|", expression[rows]) # " / " between alternatives, for "|" ends a cell
  next
}
{
  code = FILENAME ~ /\.(h|cc|inc|c|idl|proto|fbs)$/
  prose = tolower(prose_of($0, code))
  gsub(/(right of|giv[a-z]*|gave|one|either) way/, "", prose) # these are the terms of the field
  for (i = 1; i <= rows; ++i) {
    n = count_in(kind[i] == "text" ? prose : (code || FILENAME ~ /CMakeLists.txt$/ ? $0 : ""), expression[i])
    counted[i] += n
    if (n > 0 && show == pattern[i]) printf "%s:%d: %s\n", FILENAME, FNR, $0 > "/dev/stderr"
  }
}
END { for (i = 1; i <= rows; ++i) printf "%s\t%d\t%d\t%s\n", pattern[i], counted[i], most[i], instead[i] }

# Of code the comment and the string literals, of everything else the line.
function prose_of(line, code,   out, at, c, inside) {
  if (!code) return line
  out = ""
  inside = 0
  for (at = 1; at <= length(line); ++at) {
    c = substr(line, at, 1)
    if (inside) {
      if (c == "\\") { out = out substr(line, ++at, 1); continue }
      if (c == "\"") { inside = 0; out = out " "; continue }
      out = out c
    } else if (c == "\"") {
      inside = 1
    } else if (c == "/" && substr(line, at + 1, 1) == "/") {
      return out " " substr(line, at + 2)
    }
  }
  # Within a raw string a line has no quotes: prose has words, code has semicolons and braces.
  return out == "" && line !~ /[;{}()=]|^#include|^ *(case|public|private)/ ? line : out
}

function count_in(text, word,   n, at) {
  n = 0
  while (match(text, "(^|[^A-Za-z_])(" word ")([^A-Za-z_]|$)")) {
    ++n
    text = substr(text, RSTART + RLENGTH - 1)
  }
  return n
}
