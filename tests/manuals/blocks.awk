# The commands of fenced blocks of Markdown, a line each, tab-separated:
#   FILE  LINE  NEEDS ("-": none)  EXIT CODE  COMMAND
# A block counts whose info string is bash, a line of it is a command, "\" at the end continues it, and
# "exit code N" in its comment is what it must end with. A block of console holds output too: what
# follows "$ " is the command.
FNR == 1 { kind = ""; inside = 0; held = "" }
/^```/ {
  if (inside) {
    if (held != "") print_command(held)
    inside = 0
    next
  }
  inside = 1
  info = substr($0, 4)
  split(info, words, " ")
  kind = words[1]
  needs = "-"
  if (match(info, /needs=[a-z-]+/)) needs = substr(info, RSTART + 6, RLENGTH - 6)
  if (kind == "") printf "%s\t%d\tunmarked\t-\t-\n", FILENAME, FNR
  held = ""
  next
}
!inside || (kind != "bash" && kind != "console") { next }
kind == "console" && !/^\$ / { next }
/^[ \t]*(#|$)/ { next }
{
  line = $0
  if (kind == "console") sub(/^\$ /, "", line)
  if (held == "") at = FNR
  held = held line
  if (sub(/\\$/, "", held)) next
  print_command(held)
}
function print_command(text,   code) {
  code = 0
  if (match(text, /  *# .*exit code [0-9]+/) && match(text, /exit code [0-9]+/))
    code = substr(text, RSTART + 10, RLENGTH - 10)
  sub(/[ \t]+# .*$/, "", text)
  gsub(/[ \t]+/, " ", text)
  printf "%s\t%d\t%s\t%s\t%s\n", FILENAME, at, needs, code, text
  held = ""
}
