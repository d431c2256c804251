# Reads what the model printed along a trail. Writes the scenario file and prints the trail and the
# command that runs it. One tick of the model becomes half a second: a vehicle needs about that long
# from one of its places to the next.

BEGIN {
  tick_s = 0.5
  lead_s = 8             # from the start signal to tick 0: all are at their speed by then
  gate_m = 0.9           # from the crossing to where a vehicle that waits stands
  acceleration = 0.3     # m/s^2, the default profile
  gate = 3               # the model's number of that place
  late = lost = again = heard_at_all = 0
}

/^fast / { fast[$2] = $3; if ($2 > vehicles) vehicles = $2 }

/^hears / {
  heard_at_all++
  said = said sprintf(" %d<-%d:%s", $2, $3, $4 == 0 ? "-" : $4)
  link = $2 " " $3
  if ($4 == 0 || $4 > 2) lost++
  if ($4 == 2) late++
  if ($4 == 2 && last_age[link] == 1) again++
  last_age[link] = $4
}

/^crash / { crashed[$2] = tick; events = events " " $2 " dies" }

/^restart / {
  faults = faults fault("restart", $2, tick - crashed[$2])
  delete crashed[$2]
  events = events " " $2 " is back"
}

/^place / {
  # The approach that counts is the last one.
  if ($3 < gate) arrival[$2] = -1
  else if (arrival[$2] < 0 || !($2 in arrival)) arrival[$2] = tick
  places = places " " $3
}

/^tick/ {
  printf "tick %3d  places%s  hears%s%s\n", tick, places, said, events == "" ? "" : "  " events
  tick++
  places = said = events = ""
}

/START OF CYCLE/ { print "from here on for ever:" }

function fault(kind, vehicle, ticks,   text) {
  text = sprintf(" --fault %s:%d@%.1f", kind, vehicle, lead_s + tick_s * crashed[vehicle])
  # After a second of silence the world takes a vehicle for dead.
  if (kind == "restart") text = text sprintf("+%.1f", ticks * tick_s < 0.8 ? ticks * tick_s : 0.8)
  return text
}

function percent(part) { return int(100 * part / heard_at_all + 0.5) }

# Directions that all cross each other: a right angle for two, a third of a circle for three.
function write_vehicle(i,   heading, v, time, start_m, x, y) {
  heading = (i - 1) * (vehicles == 2 ? 90 : 120)
  v = fast[i] ? 0.40 : 0.30
  time = lead_s + tick_s * (arrival[i] >= 0 ? arrival[i] : tick + 4)
  start_m = gate_m + v * (time - v / (2 * acceleration))
  x = cos(heading * 3.14159265 / 180)
  y = sin(heading * 3.14159265 / 180)
  printf "vehicle {\n  id: %d\n", i > scenario
  printf "  start { x_m: %.3f y_m: %.3f heading_deg: %d }\n", 0 - start_m * x, 0 - start_m * y,
    heading > scenario
  printf "  cruise_m_s: %.2f\n", v > scenario
  printf "  goal { x_m: %.3f y_m: %.3f }\n}\n", 3 * x, 3 * y > scenario
}

END {
  printf "" > scenario
  printf "# A counter-example of tests/model: the approaches, timed as there.\n" > scenario
  printf "name: \"counter_example\"\nduration_s: 300\n" > scenario
  for (i = 1; i <= vehicles; i++) write_vehicle(i)
  printf "expect { contacts: 0 any_halted: true any_arrived: true }\n" > scenario
  close(scenario)
  for (i in crashed) faults = faults fault("crash", i, 0)
  radio = ""
  if (heard_at_all > 0 && percent(lost) > 0) radio = radio " --loss " percent(lost)
  if (late > 0) radio = radio " --jitter 50"
  if (heard_at_all > 0 && percent(again) > 0) radio = radio " --reorder " percent(again)
  printf "\nA like case in the virtual fleet:\n"
  printf "  build/release/bin/fleetctl virtual %s%s%s --seeds 1..1000\n", scenario, radio, faults
  print "Carried over: directions, speeds, who comes when, deaths and restarts, how much of the radio's"
  print "traffic was lost, late or overtaken. Not carried over: which beacon it was (the seeds try"
  print "many), earlier approaches of a vehicle that came again, and a defect injected into the model."
}
