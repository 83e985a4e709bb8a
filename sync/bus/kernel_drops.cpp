#include "sync/bus/kernel_drops.h"

#include <sys/socket.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace tactus::sync {

namespace {

// The kernel also counts messages as dropped that a socket's own filter rejects, as at the sockets of the clock probes; those
// are not losses.
bool has_filter(int fd) {
  socklen_t instructions = 0;
  return getsockopt(fd, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions) == 0 && instructions > 0;
}

}  // namespace

std::int64_t sum_drops(const std::string& table, const std::set<std::string>& inodes) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);  // headings
  std::int64_t sum = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string w; words >> w;) word.push_back(w);
    // sl local remote st queues tr:tm retrnsmt uid timeout inode ref pointer drops
    if (word.size() >= 13 && inodes.contains(word[9])) sum += std::stoll(word[12]);
  }
  return sum;
}

std::int64_t kernel_drops() {
  std::set<std::string> inodes;
  std::error_code error;
  for (const auto& fd : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string target = std::filesystem::read_symlink(fd.path(), error).string();
    if (target.starts_with("socket:[") && !has_filter(std::atoi(fd.path().filename().c_str())))
      inodes.insert(target.substr(8, target.size() - 9));
  }
  std::ifstream file("/proc/self/net/udp");
  if (!file) return -1;
  std::stringstream table;
  table << file.rdbuf();
  return sum_drops(table.str(), inodes);
}

}  // namespace tactus::sync
