// Runs each test in its own network and process namespaces, so that it cannot receive from or disturb other programs. No process of a test
// survives it, however the test ends.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tests/run_tests.h"

namespace {

constexpr const char* kInside = "TACTUS_TEST_INSIDE";
constexpr int kExitSkipped = 77;  // the skip code that CTest expects
constexpr const char* kNetwork =
    "PATH=$PATH:/usr/sbin:/sbin; ip link set lo up && ip route add 224.0.0.0/4 dev lo || exit 77; exec \"$0\" \"$@\"";

bool only_lists(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (strncmp(argv[i], "--list", 6) == 0 || strcmp(argv[i], "--help") == 0) return true;
  return false;
}

std::vector<std::string> unshare_words() {
  std::vector<std::string> words{"unshare"};
  if (geteuid() != 0) words.insert(words.end(), {"--user", "--map-root-user"});
  words.insert(words.end(), {"--net", "--pid", "--fork", "--kill-child", "--mount-proc"});
  return words;
}

bool may_unshare() {
  std::string command;
  for (const std::string& word : unshare_words()) command += word + " ";
  return system((command + "true 2>/dev/null").c_str()) == 0;
}

int enter(int argc, char** argv) {
  if (!may_unshare()) {
    std::cout << "skipped: this system does not allow network namespaces\n";
    return kExitSkipped;
  }
  setenv(kInside, "1", 1);
  std::vector<std::string> words = unshare_words();
  words.insert(words.end(), {"sh", "-c", kNetwork});
  words.push_back(std::filesystem::read_symlink("/proc/self/exe"));
  words.insert(words.end(), argv + 1, argv + argc);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());
  std::cerr << "cannot start unshare; install util-linux\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (!only_lists(argc, argv) && !getenv(kInside)) return enter(argc, argv);
  return tactus::run_tests(argc, argv);
}
