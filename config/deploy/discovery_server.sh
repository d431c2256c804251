#!/bin/sh
# Runs fast-discovery-server with these arguments, and starts it again within a moment whenever a signal
# ends it: it has no packet filter, so that one packet can (config/security/README.md). Engines start
# containers again ever more rarely, Kubernetes after up to five minutes; this is as quick each time.
# Where the server ends by itself, bad arguments for one, its exit code is this one's.
#
# SIGTERM and SIGINT end both: the server by SIGINT, the only one that 2.9.1 says farewell at.
set -u
over=''
server=''
end() {
  over=yes
  [ -z "$server" ] || kill -INT "$server" 2>/dev/null
}
trap end TERM INT
while :; do
  fast-discovery-server "$@" &
  server=$!
  [ -z "$over" ] || end
  code=0
  wait "$server" || code=$?
  while kill -0 "$server" 2>/dev/null; do # the wait ended by a signal to this shell
    code=0
    wait "$server" || code=$?
  done
  [ -z "$over" ] || exit 0
  [ "$code" -gt 128 ] || exit "$code"
  echo "the discovery server was ended by signal $((code - 128)): starts it again" >&2
  sleep 0.1
done
