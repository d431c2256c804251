# shellcheck shell=bash
# The rows of qos_effects.sh: value -> another, its set, the figures that show it, the options of both
# fleets, and the edit. Sourced, never run.

# profile NAME ELEMENT: the path of an element of one profile.
profile() { echo "//*[@profile_name='$1']//d:$2"; }
cost=packets_s,kB_s,cpu_s_min,threads,rss_MB

# The library, the transport, the participant.
row 'intraprocess_delivery OFF -> FULL' default "$cost" '' \
  -u '//d:intraprocess_delivery' -v FULL
row 'receiveBufferSize 1 MiB -> none' default overflows 'stop_vehicle=3 seconds=2' \
  -d '//d:receiveBufferSize'
row 'TTL 1 -> 16' default multicast_ttl,unicast_ttl 'capture=yes seconds=1' -u '//d:TTL' -v 16
row 'useBuiltinTransports false -> true' default "$cost" '' -u '//d:useBuiltinTransports' -v true
row 'leaseDuration 10 -> 20 s, of lossy_radio' lossy_radio unmatched_ms,unmatched_alive \
  'vehicles=4 seconds=1 silence=23' -u "//d:discovery_config/d:leaseDuration/d:sec" -v 10
row 'leaseAnnouncement 1 -> 3 s' default multicasts_s,packets_s,all_matched_ms '' \
  -u '//d:leaseAnnouncement/d:sec' -v 3
for lost in 30 60; do
  row "leaseAnnouncement 1 -> 3 s, $lost % lost" default all_matched_ms,matched \
    "impair=loss=0.$lost seconds=1 wait=40" -u '//d:leaseAnnouncement/d:sec' -v 3
done
row 'mutation_tries 400 -> 10' default speaking,matched 'vehicles=12 seconds=1' \
  -u '//d:mutation_tries' -v 10
row 'initialAnnouncements 20 -> 5, 30 % lost' lossy_radio all_matched_ms,matched \
  'impair=loss=0.3 seconds=1 wait=30' -d '//d:initialAnnouncements'

# Limits, on every endpoint.
row 'max_instances 0 -> default, 12 vehicles' default matched,peers_heard,beacons_taken_s \
  'vehicles=12 seconds=3' -d "$(profile fleet_beacon_reader max_instances)"
row 'max_instances 0 -> default, of the world' default matched,driving \
  'vehicles=12 seconds=3' -d "$(profile fleet_motor_command_reader max_instances)"
row 'max_samples 0 -> default' default beacons_taken_s '' -d '//d:max_samples'
row 'max_samples_per_instance 0 -> default' default beacons_taken_s,beacons_lost,rss_MB '' \
  -d '//d:max_samples_per_instance'
limits=$(profile fleet_beacon_writer 'resourceLimitsQos/*')
row 'all max_ 0 -> default, of a writer' default peers_heard,beacons_taken_s 'seconds=3' -d "$limits"
row 'all max_ 0 -> -1, of a writer' default peers_heard,beacons_taken_s 'seconds=3 wait=8' \
  -u "$limits" -v -1

# Histories.
row 'every depth 1 -> 4' default "$cost,beacons_superseded" '' \
  -u "//d:depth[.='1']" -v 4
row 'depth of fleet_beacon_reader 4 -> 1' default beacons_superseded,beacons_taken_s '' \
  -u "$(profile fleet_beacon_reader depth)" -v 1
row 'depth of lossy fleet_beacon_reader 8 -> 4' lossy_radio beacons_superseded,beacons_taken_s \
  'impair=delay=150ms,jitter=150ms,loss=0.1' -u "$(profile fleet_beacon_reader depth)" -v 4
row 'depth of world_ranges_reader 4 -> 1' default ranges_skipped 'stop_vehicle=0.5' \
  -u "$(profile world_ranges_reader depth)" -v 1
row 'depth of fleet_motor_command_reader 4 -> 1' default "$cost" '' \
  -u "$(profile fleet_motor_command_reader depth)" -v 1
row 'depth of world_truth_reader 32 -> 1' default truths_missing \
  'listen=world/truth stop_observers=1' -u "$(profile world_truth_reader depth)" -v 1
row 'depth of fleet_status_reader 16 -> 1' default statuses 'stop_observers=3' \
  -u "$(profile fleet_status_reader depth)" -v 1
row 'depth of world_event 256 -> 1' default late_events 'listen=world/event seconds=1' \
  -u "//*[starts-with(@profile_name, 'world_event')]//d:depth" -v 1
row 'depth of world_roster_reader 4 -> 1' default all_matched_ms,late_entries \
  'listen=world/roster seconds=1' -u "$(profile world_roster_reader depth)" -v 1
row 'depth of fleet_admin_reader 8 -> 1' default answered 'ask=4 seconds=0' \
  -u "$(profile fleet_admin_reader depth)" -v 1
row 'depth of fleet_answer 8 -> 1' default answered 'ask=4 seconds=0' \
  -u "//*[starts-with(@profile_name, 'fleet_answer')]//d:depth" -v 1
row 'historyMemoryPolicy DYNAMIC -> default' default "$cost" '' -d '//d:historyMemoryPolicy'

# Reliability and durability. durability NAME VALUE: of both sides.
reliability() { echo "//*[starts-with(@profile_name, '$1')]//d:reliability/d:kind"; }
durability() { echo "//*[starts-with(@profile_name, '$1')]//d:durability/d:kind"; }
row 'reliability of fleet_beacon -> RELIABLE' default "$cost" '' \
  -u "$(reliability fleet_beacon)" -v RELIABLE
row 'reliability of world_ranges -> RELIABLE' default "$cost" '' \
  -u "$(reliability world_ranges)" -v RELIABLE
row 'reliability of fleet_motor_command -> RELIABLE' default "$cost" '' \
  -u "$(reliability fleet_motor_command)" -v RELIABLE
row 'reliability of world_signal -> RELIABLE' default "$cost" '' \
  -u "$(reliability world_signal)" -v RELIABLE
row 'reliability of world_truth -> RELIABLE' default "$cost,truths_missing" \
  'listen=world/truth' -u "$(reliability world_truth)" -v RELIABLE
row 'reliability of fleet_status -> BEST_EFFORT' default packets_s,statuses '' \
  -u "$(reliability fleet_status)" -v BEST_EFFORT
row 'durability of fleet_beacon -> TRANSIENT_LOCAL' default "$cost" '' \
  -u "$(durability fleet_beacon)" -v TRANSIENT_LOCAL
row 'durability of fleet_join, world_roster -> VOLATILE' default \
  all_matched_ms,late_drives_ms,late_entries 'listen=world/roster late=yes' \
  -u "$(durability fleet_join)" -v VOLATILE -u "$(durability world_roster)" -v VOLATILE
row 'durability of world_event -> VOLATILE' default late_events 'listen=world/event seconds=1' \
  -u "$(durability world_event)" -v VOLATILE
row 'durability of world_figures -> VOLATILE' default figures_heard 'listen=world/figures seconds=0' \
  -u "$(durability world_figures)" -v VOLATILE
row 'durability of fleet_answer -> VOLATILE' default answered 'ask=4 seconds=0' \
  -u "$(durability fleet_answer)" -v VOLATILE

# Deadlines and liveliness. Twice: nothing lost, and one packet in ten.
deadline() { echo "//*[@profile_name='$1']//d:deadline//d:nanosec"; }
sensors="$(deadline world_radar_reader)|$(deadline world_lidar_reader)"
sensors+="|$(deadline world_camera_reader)|$(deadline world_ranges_reader)"
for impair in none loss=0.1; do
  options="impair=$impair seconds=$([[ $impair == none ]] && echo 5 || echo 20)"
  row "deadline of sensors 150 -> 200, of signals 300 -> 200 ms, $impair" default \
    ranges_misses_hour,sensors_misses_hour,signals_misses_hour "$options" -u "$sensors" -v 200000000 \
    -u "$(deadline world_signal_reader)" -v 200000000
  row "deadline of lossy fleet_beacon_reader 200 -> 150 ms, $impair" lossy_radio misses_hour \
    "$options" -u "$(deadline fleet_beacon_reader)" -v 150000000
done
row "lease of lossy fleet_beacon 500 -> 250 ms, 30 % lost" lossy_radio liveliness_lost_hour \
  'impair=loss=0.3' -u "//*[starts-with(@profile_name, 'fleet_beacon')]//d:liveliness//d:nanosec" \
  -v 250000000
row 'deadline of fleet_beacon_writer 100 -> 160 ms' default matched,peers_heard 'seconds=1 wait=8' \
  -u "$(deadline fleet_beacon_writer)" -v 160000000
row 'deadline of fleet_motor_command -> none' default "$cost" '' \
  -d "//*[starts-with(@profile_name, 'fleet_motor_command')]//d:deadline"
# AUTOMATIC needs a period in which the library asserts it, shorter than the lease.
automatic() { # NAME: the edit of both sides, in `edit`
  local of="//*[starts-with(@profile_name, '$1')]//d:liveliness" new="*[local-name()='announcement_period']"
  edit=(-u "$of/d:kind" -v AUTOMATIC -s "$of" -t elem -n announcement_period
    -s "$of/$new" -t elem -n sec -v 0 -s "$of/$new" -t elem -n nanosec -v 100000000)
}
automatic world_ranges
row 'liveliness of world_ranges -> AUTOMATIC' default "$cost" '' "${edit[@]}"
automatic fleet_beacon
row 'liveliness of fleet_beacon -> AUTOMATIC' default "$cost" '' "${edit[@]}"

# Publishing, shared memory, another discovery protocol.
row 'publishMode SYNCHRONOUS -> ASYNCHRONOUS' default "$cost" '' -u '//d:publishMode/d:kind' -v ASYNCHRONOUS
row 'data_sharing OFF -> AUTOMATIC' default "$cost,shared_maps,shm_files,shm_kB,shm_left" '' \
  -u '//d:data_sharing/d:kind' -v AUTOMATIC
row 'same_host: shared memory -> UDP alone' same_host \
  "$cost,sockets,shared_maps,shm_files,shm_kB,shm_left" '' \
  -d "//d:userTransports/d:transport_id[.='giveway_shm']"
row 'segment_size 512 kiB -> 64 kiB' same_host shm_kB,beacons_taken_s,beacons_lost '' \
  -u '//d:segment_size' -v 65536
row 'port_queue_capacity 1024 -> 64' same_host shm_kB,beacons_taken_s,beacons_lost '' \
  -u '//d:port_queue_capacity' -v 64
row 'discoveryProtocol CLIENT -> SIMPLE' wan_discovery_server \
  "$cost,multicasts_s,all_matched_ms" 'server_after=0' -d '//d:discoveryProtocol' \
  -d '//d:discoveryServersList' -d '//d:clientAnnouncementPeriod'
row 'clientAnnouncementPeriod 450 -> 3000 ms' wan_discovery_server all_matched_ms \
  'server_after=2 seconds=1' -u '//d:clientAnnouncementPeriod/d:sec' -v 3 \
  -u '//d:clientAnnouncementPeriod/d:nanosec' -v 0
