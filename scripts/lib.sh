# Shared by the scripts of this folder: source it after `set -euo pipefail`.

# catkin's Python is the system's: nothing may stand before it.
export PATH=/usr/bin:/bin:/usr/sbin:/sbin:$PATH

LODESTAR_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }

fail() {
  printf '\n%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# step "what a failure means" command...: runs the command, ends with that one sentence when it fails.
step() {
  local meaning=$1
  shift
  "$@" || fail "$meaning"
}

# The comment at the head of a script, without its first line, is its help.
help() { sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"; }

system_name() { (. /etc/os-release 2>/dev/null && echo "${ID:-unknown}-${VERSION_ID:-unknown}"); }

# On Ubuntu ROS lives in a folder of its own.
use_ros() {
  if [ -f /opt/ros/noetic/setup.bash ]; then
    set +u
    . /opt/ros/noetic/setup.bash
    set -u
  fi
}

# Nodes find each other by name: a host name that does not resolve stops every launch.
use_local_ros_network() {
  if ! getent hosts "$(hostname)" >/dev/null 2>&1; then
    export ROS_HOSTNAME=localhost ROS_IP=127.0.0.1
  fi
}

# Jobs for the compiler: a file of the edge takes about 1 GB.
jobs_for_this_machine() {
  local processors memory_gb
  processors=$(nproc)
  memory_gb=$(($(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo) / 1000000))
  [ "$memory_gb" -ge 1 ] || memory_gb=1
  echo $((processors < memory_gb ? processors : memory_gb))
}
