#!/usr/bin/env bash
# Which orders a service accepts: none by default; with a key only those sealed with it; with --admin
# and no key all. Prints a line a row, "ok" or "FAILED".
source "$(dirname "${BASH_SOURCE[0]}")/../support/members.sh"
unset GIVEWAY_QOS GIVEWAY_ADMIN GIVEWAY_ADMIN_KEY
take_domain
cd "$SCRATCH" || exit 2
printf '%s\n' 0123456789abcdef0123456789abcdef >right.key
printf '%s\n' fedcba9876543210fedcba9876543210 >wrong.key
printf 'short\n' >short.key
sed '/profile_name="fleet_beacon_reader"/,/<\/data_/ s/<nanosec>150000000/<nanosec>180000000/' \
  "$REPOSITORY/config/qos/default.xml" >deadline.xml
sed '/profile_name="fleet_beacon_reader"/,/<\/data_/ s/<nanosec>150000000/<nanosec>190000000/' \
  "$REPOSITORY/config/qos/default.xml" >other.xml

start world giveway-world
start a giveway-vehicle --admin-key right.key
start b giveway-vehicle
start c giveway-vehicle --admin
for vehicle in a b c; do await "$vehicle drives" 15 "$vehicle" cruise; done

# order CODE WHAT PROFILES VEHICLE ARGUMENTS...
order() {
  local wanted=$1 what=$2 profiles=$3 vehicle=$4 code=0
  shift 4
  timeout 60 "$FLEETCTL" qos apply "$profiles" --to "$(id_of "$vehicle")" --domain "$DOMAIN" "$@" \
    >out 2>&1 || code=$?
  if [[ $code -eq $wanted ]]; then
    printf '%-7s %s\n' ok "$what"
  else
    printf '%-7s %s: exit code %s: %s\n' FAILED "$what" "$code" "$(tail -n 2 out)"
    failures=$((failures + 1))
  fi
}
order 2 "no key: no order is taken" deadline.xml a
order 2 "the wrong key" deadline.xml a --admin-key wrong.key
order 0 "the right key" deadline.xml a --admin-key right.key
order 2 "a service that takes no orders" deadline.xml b --admin-key right.key
order 0 "a service that takes any" deadline.xml c
order 2 "a key that is too short is refused" other.xml a --admin-key short.key
grep -q 'not sealed with the key' "$SCRATCH/a.log" || fail "a did not say why it refused"
code=0
timeout 10 "$(dirname "$FLEETCTL")/giveway-vehicle" --scenario intersection_yield --domain "$DOMAIN" \
  --admin-key missing.key 2>err || code=$?
if [[ $code -ne 2 ]] || ! grep -q 'admin key missing.key' err; then
  fail "a missing key: exit code $code: $(cat err)"
fi
no_contact
[[ $failures -eq 0 ]]
