# shellcheck shell=bash
# Sourced by bounds.sh and mutants.sh: the figures of a virtual run, and which of them are outside the bounds of
# bounds.txt.

# A figure may be outside what was recorded by the larger of a share of it and a number. Half as much was not
# enough for one draw of the radio in ten.
readonly figures_share=0.02 figures_by=0.03

# figures: of the JSON of `fleetctl virtual` on stdin, "NAME VALUE" a line: contacts and vehicles that did not
# arrive, counted over all runs, and means over all vehicles.
figures() {
  jq -er 'select(.verdict != "not_run") | "contacts \(.contacts)", "missing \(.vehicles - .arrived)",
    "delay_s \(.delay_s.mean // 0)", "stops \(.traffic.stops)",
    "taken_back \(.traffic.taken_back)", (.traffic.by_rule[] | "\(.rule)_s \(.mean_s)")'
}

# bounds_of FILE RUN: "NAME LOW HIGH" a line.
bounds_of() {
  awk -v run="$2" '$1 == "run" { inside = $0 == "run " run; next } inside && !/^#/ && NF == 3' "$1"
}

# outside BOUNDS FIGURES: those outside, "NAME VALUE, not LOW..HIGH" a line; a figure on one side alone is 0 on
# the other.
outside() {
  awk -v share="$figures_share" -v by="$figures_by" '
    NR == FNR { low[$1] = $2; high[$1] = $3; names[$1]; next }
    { value[$1] = $2; names[$1] }
    END {
      for (name in names) {
        more = share * high[name] > by ? share * high[name] : by
        if (value[name] >= low[name] - more && value[name] <= high[name] + more) continue
        printf "%s %.3f, not %.3f..%.3f\n", name, value[name], low[name], high[name]
      }
    }' <(echo "$1") <(echo "$2") | sort
}
