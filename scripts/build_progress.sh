# Sourced by scripts/build: the progress of ninja, as compiled files of all and the remaining time.

# Begins the lines of progress among the lines of compilers; %e is the elapsed time (ninja manual, NINJA_STATUS).
progress_mark='@progress '
progress_status="$progress_mark%e "

# files_to_compile WORD...: the number of files that the command WORD... of ninja would compile.
files_to_compile() { "$@" -n 2>/dev/null | grep -c ' Building C'; }

# remaining ELAPSED_S DONE ALL: the remaining time in words. Assumes that the other files take as long as those that are compiled.
remaining() {
  local left=$(($1 * ($3 - $2) / $2))
  if ((left >= 90)); then echo "about $(((left + 59) / 60)) min left"; else echo "about $(((left + 9) / 10 * 10)) s left"; fi
}

# progress ALL TERMINAL: reads the output of ninja. Prints the progress to stdout, in one line that is overwritten on a terminal (TERMINAL
# is yes), otherwise one line a minute. All other lines go to stderr. Prints nothing when nothing is compiled.
progress() {
  local all=$1 terminal=$2 files=0 next_s=60 line elapsed_s text=''
  while IFS= read -r line; do
    case $line in
      "$progress_mark"*' Building C'*) ;;
      "$progress_mark"* | 'ninja: no work to do.' | 'ninja: Entering directory'*) continue ;;
      *)
        [[ $terminal == no || -z $text ]] || printf '\r\033[K'
        printf '%s\n' "$line" >&2
        continue ;;
    esac
    files=$((files + 1))
    ((all >= files)) || all=$files
    elapsed_s=${line#"$progress_mark"} elapsed_s=${elapsed_s%%.*}
    [[ $elapsed_s =~ ^[0-9]+$ ]] || elapsed_s=0
    text="build: $files of $all files compiled"
    ((files < 5 || files == all)) || text+=", $(remaining "$elapsed_s" "$files" "$all")"
    if [[ $terminal == yes ]]; then
      printf '\r\033[K%s' "$text"
    elif ((elapsed_s >= next_s)); then
      next_s=$((elapsed_s + 60))
      printf '%s\n' "$text"
    fi
  done
  [[ $terminal == no || -z $text ]] || printf '\r\033[K'
}
