# Prologue of every bash script of Tactus, sourced first; python/tactus/environment.py does the same for scripts/tactus. Removes what
# would change the script: variables of the user's shell, closed streams, libraries that cannot be loaded. Defines `program`, `here` (the
# folder of the script after all links), `fail`, and `called`.
#
# #!/bin/bash -p ignores functions and start files of the user (bash(1), privileged mode); `bash FILE` starts again in this way.
[[ -o privileged ]] || exec /bin/bash -p -- "${BASH_SOURCE[1]}" "$@"
set +o posix

program=${BASH_SOURCE[1]##*/}
fail() { printf '%s: %s\n' "$program" "${*//$'\n'/\\n}" >&2; exit 1; }  # one line, also with a name that holds line ends

# In place of a closed stream, the next file that a program opens would receive its output.
[[ -e /proc/self/fd/0 ]] || exec 0</dev/null
[[ -e /proc/self/fd/1 ]] || exec 1>/dev/null
[[ -e /proc/self/fd/2 ]] || exec 2>/dev/null

while read -r name _; do
  case $name in
    '' | '#') ;;
    *\*) for name in $(compgen -A variable -- "${name%\*}"); do unset -v "$name"; done ;;
    *) unset -v "$name" ;;
  esac
done <"${BASH_SOURCE[0]%/*}/removed_variables.txt"
[[ -n ${TMPDIR-} && -d $TMPDIR && -w $TMPDIR && -x $TMPDIR ]] || unset -v TMPDIR

# Each program would report a library that cannot be loaded, and that output would look like an error of the program.
if [[ -n ${LD_PRELOAD-} ]]; then
  IFS=': ' read -r -a libraries <<<"$LD_PRELOAD"
  unset -v LD_PRELOAD
  for name in "${libraries[@]}"; do
    [[ -n $(LD_PRELOAD=$name exec /bin/true 2>&1) ]] || export LD_PRELOAD=${LD_PRELOAD:+$LD_PRELOAD:}$name
  done
  unset -v libraries
fi
unset -v name
# A locale that is not installed: each script would print a warning.
[[ -z $( { LC_ALL=${LC_ALL-${LANG-}}; } 2>&1 ) ]] || export LC_ALL=C.UTF-8

here=$(dirname -- "$(readlink -f -- "${BASH_SOURCE[1]}")")
pwd -P >/dev/null 2>&1 && [[ -x . ]] || fail "the current folder does not exist any more, or this user cannot enter it; change to another folder"

# The script that the user started reports Ctrl-C in one line, and the scripts that it calls are silent. A signal that the caller ignores
# stays ignored: bash cannot trap it.
caller=${TACTUS_CALLER-}
unset -v TACTUS_CALLER
interrupted() {
  trap '' INT
  [[ -n $caller ]] || printf '%s: interrupted\n' "$program" >&2
  exit 130
}
trap interrupted INT
# called SCRIPT WORD...: runs another script of Tactus.
called() { TACTUS_CALLER=$program "$@"; }
