# What ./dev does before a build, and how it shows one: sourced by it, and by tests/packaging/setup_test.py.

say() { printf '%s\n' "$*" >&2; }

# list_missing PACKAGE ...: those that are not installed. Nothing on systems without dpkg: CMake looks for the libraries.
list_missing() {
  command -v dpkg-query >/dev/null || return 0
  local p
  for p in "$@"; do
    dpkg-query -W -f='${Status}' "$p" 2>/dev/null | grep -q 'ok installed' || printf '%s ' "$p"
  done
}

# follow WHAT LOG: keeps its input in the log and shows how far a program is, by the steps of ninja ([3/40] ...) or the
# states of apt (pmstatus:NAME:PERCENT:...): one line of a terminal, elsewhere a line for each tenth.
follow() {
  local what="$1" log="$2" line share="" shown=-1 begin="$SECONDS" left now=""
  while IFS= read -r line; do
    printf '%s\n' "$line" >>"$log"
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      share=$((1000 * BASH_REMATCH[1] / BASH_REMATCH[2]))
    elif [[ $line =~ ^(pm|dl)status:.*:([0-9]+)\.([0-9])[0-9]*:(.*) ]]; then
      now=", ${BASH_REMATCH[4]:0:40}"
      share="${BASH_REMATCH[2]}${BASH_REMATCH[3]:-0}"
      share=$((10#$share / 2))   # downloads are one half, unpacking and setting up the other
      [ "${BASH_REMATCH[1]}" = dl ] || share=$((500 + share))
    else
      continue
    fi
    left=""
    # The first twentieth tells little about the rest.
    [ "$share" -lt 50 ] || left=", about $(((SECONDS - begin) * (1000 - share) / share / 60 + 1)) min left"
    [ "$share" -lt 1000 ] || left=""
    if [ -t 2 ]; then
      printf '\r%s: %d %%%s%s\033[K' "$what" $((share / 10)) "$left" "$now" >&2
    elif [ $((share / 100)) -gt "$shown" ]; then
      say "$what: $((share / 10)) %$left"
    fi
    shown=$((share / 100))
  done
  [ -z "$share" ] || [ ! -t 2 ] || say ""
}

# install_packages PACKAGE ...: by apt, as root or with sudo; what apt says goes to a log, and its errors are shown.
install_packages() {
  local log sudo=""
  log="$(mktemp)"
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      say "error: these packages are missing, and there is neither root nor sudo to install them; as root:"
      say "  apt-get install --no-install-recommends $*"
      return 3
    fi
    sudo=sudo
  fi
  if { $sudo apt-get update && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
        -o APT::Status-Fd=1 "$@"; } 2>&1 | follow "installing $# package$([ $# -eq 1 ] || echo s)" "$log"; then
    rm -f "$log"
    return 0
  fi
  grep -E '^(E|W|Err):' "$log" >&2 || tail -n 20 "$log" >&2
  say "error: apt could not install $*; all that it says is in $log. As root or with sudo on Debian 12, or install" \
    "what docs/install.md lists and build by cmake"
  return 3
}

# build_all FOLDER ARGUMENT ...: cmake --build with its output in FOLDER/build.log; BOUGH_VERBOSE=1 shows all of it.
build_all() {
  local folder="$1" log="$1/build.log" count
  shift
  [ -z "${BOUGH_VERBOSE:-}" ] || { cmake --build "$folder" "$@" >&2; return; }
  : >"$log"
  if ! cmake --build "$folder" "$@" 2>&1 | follow building "$log"; then
    grep -n -m 1 -A 20 '^CMake Error' "$log" >&2 || grep -n -m 1 -A 60 '^FAILED:' "$log" >&2 || tail -n 30 "$log" >&2
    say "error: the build failed; all of its output is in $log"
    return 1
  fi
  count="$(grep -c 'warning:' "$log")" || true
  [ "$count" = 0 ] || say "$count warnings of the compiler, in $log"
}
