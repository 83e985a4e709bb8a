# Sourced by scripts/build: the progress of ninja, as files made of all and the remaining time.

# Begins the lines of progress among the lines of compilers: finished and all steps, elapsed time (ninja manual, NINJA_STATUS). A step makes a
# file. A dry run (ninja -n) cannot give the number: with folders that CMake checks for new files it ends after that check.
progress_mark='@progress '
progress_status="$progress_mark%f %t %e "

# remaining ELAPSED_S DONE LEFT: the remaining time in words, if the files that are left take as long as those that are done.
remaining() {
  local left=$(($1 * $3 / $2))
  if ((left >= 90)); then echo "about $(((left + 59) / 60)) min left"; else echo "about $(((left + 9) / 10 * 10)) s left"; fi
}

# progress TERMINAL: reads the output of ninja. Prints the progress to stdout, in one line that is overwritten on a terminal (TERMINAL is yes),
# otherwise one line a minute. All other lines go to stderr. Prints nothing before the first compiled file: generated files take no time.
progress() {
  local terminal=$1 next_s=60 first='' first_s line done all elapsed_s text=''
  while IFS= read -r line; do
    case $line in
      "$progress_mark"*) read -r _ done all elapsed_s _ <<<"$line" ;;
      'ninja: no work to do.' | 'ninja: Entering directory'*) continue ;;
      *)
        [[ $terminal == no || -z $text ]] || printf '\r\033[K'
        printf '%s\n' "$line" >&2
        continue ;;
    esac
    elapsed_s=${elapsed_s%%.*}
    [[ $done =~ ^[0-9]+$ && $all =~ ^[0-9]+$ && $elapsed_s =~ ^[0-9]+$ ]] || continue
    if [[ -z $first ]]; then
      [[ $line == *' Building C'* ]] || continue
      first=$done first_s=$elapsed_s
    fi
    text="build: $done of $all files"
    ((done < first + 5 || done >= all)) || text+=", $(remaining $((elapsed_s - first_s)) $((done - first)) $((all - done)))"
    if [[ $terminal == yes ]]; then
      printf '\r\033[K%s' "$text"
    elif ((elapsed_s >= next_s)); then
      next_s=$((elapsed_s + 60))
      printf '%s\n' "$text"
    fi
  done
  [[ $terminal == no || -z $text ]] || printf '\r\033[K'
}
