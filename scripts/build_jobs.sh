# Sourced by scripts/build: the number of compilers that run side by side.

# A compiler needs up to 1.5 GB for files with Eigen.
compiler_kB=1500000

# free_memory_kB [PROC [GROUPS]]: the memory that is left for this process: that of the machine, or less in a container or another
# control group with a limit (Linux, cgroup-v2.rst: memory.max; cgroup-v1/memory.txt). The cached files of a group count as free.
free_memory_kB() {
  local proc=${1:-/proc} groups=${2:-/sys/fs/cgroup} least controllers path folder limit usage cache cached most used free
  least=$(awk '/^MemAvailable:/ {print $2}' "$proc/meminfo")
  while IFS=: read -r _ controllers path; do
    case ,$controllers, in
      ,,) folder=$groups limit=memory.max usage=memory.current cache=inactive_file
        [[ ! -d $groups/unified ]] || folder=$groups/unified ;;
      *,memory,*) folder=$groups/memory limit=memory.limit_in_bytes usage=memory.usage_in_bytes cache=total_inactive_file ;;
      *) continue ;;
    esac
    while :; do  # the group itself, and all that contain it
      if read -r most 2>/dev/null <"$folder$path/$limit" && [[ $most =~ ^[0-9]+$ ]] && read -r used 2>/dev/null <"$folder$path/$usage"; then
        cached=$(awk -v name="$cache" '$1 == name {print $2}' "$folder$path/memory.stat" 2>/dev/null)
        free=$(((most - used + ${cached:-0}) / 1024))
        ((free < least)) && least=$free
      fi
      [[ $path == */* ]] || break
      path=${path%/*}
    done
  done <"$proc/self/cgroup"
  echo "$least"
}

# build_jobs [PROC [GROUPS]]: at least 1, at most the number of processors.
build_jobs() {
  local jobs cores
  jobs=$(($(free_memory_kB "$@") / compiler_kB))
  cores=$(nproc)
  ((jobs > cores)) && jobs=$cores
  ((jobs < 1)) && jobs=1
  echo "$jobs"
}
