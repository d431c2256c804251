# shellcheck shell=bash
# jq for scripts that judge with it. Sourced, never run. With -e, jq 1.6 ends with 0 where it was given nothing at
# all to judge; here, as from 1.7 on, with 4: an empty report is no passed one.
jq() {
  local judged code=0
  if [[ ${1:-} != -e && ${1:-} != -se ]]; then
    command jq "$@"
    return
  fi
  judged=$(command jq "$@") || code=$?
  [[ -z $judged ]] || printf '%s\n' "$judged"
  [[ $code -ne 0 || -n $judged ]] || code=4
  return "$code"
}
