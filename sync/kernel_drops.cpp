#include "sync/kernel_drops.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace tactus::sync {

namespace {

// Over the lines of which wanted(words) holds.
std::int64_t sum(const std::string& table, const auto& wanted) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);  // headings
  std::int64_t sum = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string w; words >> w;) word.push_back(w);
    // sl local remote st queues tr:tm retrnsmt uid timeout inode ref pointer drops
    if (word.size() >= 13 && wanted(word)) sum += std::stoll(word[12]);
  }
  return sum;
}

}  // namespace

std::int64_t sum_drops(const std::string& table, const std::set<std::string>& inodes) {
  return sum(table, [&](const std::vector<std::string>& word) { return inodes.contains(word[9]); });
}

std::int64_t drops_of_port(const std::string& table, int port) {
  char end[8];
  std::snprintf(end, sizeof end, ":%04X", static_cast<unsigned>(port));
  return sum(table, [&](const std::vector<std::string>& word) { return word[1].ends_with(end); });
}

std::int64_t kernel_drops() {
  std::set<std::string> inodes;
  std::error_code error;
  for (const auto& fd : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string target = std::filesystem::read_symlink(fd.path(), error).string();
    if (target.starts_with("socket:[")) inodes.insert(target.substr(8, target.size() - 9));
  }
  std::ifstream file("/proc/self/net/udp");
  if (!file) return -1;
  std::stringstream table;
  table << file.rdbuf();
  return sum_drops(table.str(), inodes);
}

}  // namespace tactus::sync
