// Runs a fuzz target without libFuzzer: its seeds and regressions, then RUNS mutations of them, the same in every run.
//
//    fuzz_NAME RUNS [--from N] FOLDER...
//
// --from N: begins with mutation number N, to continue an earlier run.
// A failing input is written to fuzz_NAME.failed in the current folder; keep it under tests/fuzz/regressions/NAME.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kLongest = 1 << 20;

Bytes present;
std::string failed_path;

// Writes the current input to failed_path, then raises the signal again with its default action.
void keep(int signal) {
  const int file = open(failed_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && write(file, present.data(), present.size()) >= 0) close(file);
  ::signal(signal, SIG_DFL);
  raise(signal);
}

std::vector<Bytes> seeds_of(const std::vector<std::string>& folders) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& folder : folders)
    if (std::filesystem::is_directory(folder))
      for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

std::size_t below(std::mt19937& random, std::size_t n) { return n == 0 ? 0 : random() % n; }

void overwrite(Bytes& b, std::mt19937& random) {
  // Edge values of integers and floating point numbers.
  static constexpr std::uint64_t kEdges[] = {0,
                                             1,
                                             0x7f,
                                             0x80,
                                             0xff,
                                             0x7fff,
                                             0x8000,
                                             0xffff,
                                             0x7fffffff,
                                             0x80000000,
                                             0xffffffff,
                                             0x7fffffffffffffff,
                                             0x8000000000000000,
                                             0xffffffffffffffff,
                                             0x7ff0000000000000,
                                             0x7ff8000000000000,
                                             0x4340000000000000,
                                             0x7f800000};
  const std::uint64_t edge = kEdges[below(random, std::size(kEdges))];
  const std::size_t bytes = std::size_t{1} << below(random, 4);
  if (b.size() < bytes) return;
  const std::size_t at = below(random, b.size() - bytes + 1);
  for (std::size_t i = 0; i < bytes; ++i) b[at + i] = static_cast<std::uint8_t>(edge >> 8 * (bytes - 1 - i));
}

// One small change.
void change(Bytes& b, const Bytes& other, std::mt19937& random) {
  const auto begin = [&](std::size_t at) { return b.begin() + static_cast<std::ptrdiff_t>(at); };
  switch (random() % 8) {
    case 0:
    case 1:
      if (!b.empty()) b[below(random, b.size())] ^= static_cast<std::uint8_t>(1u << random() % 8);
      return;
    case 2:
      if (!b.empty()) b[below(random, b.size())] = static_cast<std::uint8_t>(random());
      return;
    case 3: return overwrite(b, random);
    case 4: {  // truncates
      const std::size_t at = below(random, b.size());
      b.erase(begin(at), begin(std::min(b.size(), at + 1 + below(random, 64))));
      return;
    }
    case 5: {  // repeats a piece of the input
      const std::size_t at = below(random, b.size()), n = std::min(b.size() - at, 1 + below(random, 64));
      const Bytes piece(begin(at), begin(at + n));
      b.insert(begin(below(random, b.size() + 1)), piece.begin(), piece.end());
      return;
    }
    case 6: {  // inserts a piece of another input
      const std::size_t at = below(random, other.size()), n = std::min(other.size() - at, 1 + below(random, 256));
      const auto from = other.begin() + static_cast<std::ptrdiff_t>(at);
      b.insert(begin(below(random, b.size() + 1)), from, from + static_cast<std::ptrdiff_t>(n));
      return;
    }
    default: b.resize(below(random, b.size() + 1));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const bool continued = argc > 4 && std::string(argv[2]) == "--from";
  if (argc < 3 || (!continued && std::string(argv[2]).starts_with("--"))) {
    std::cerr << "usage: fuzz_NAME RUNS [--from N] FOLDER...: replays the seeds of the folders and RUNS mutations of them, from number N\n";
    return 1;
  }
  const long first = continued ? std::atol(argv[3]) : 0;
  const std::string name = std::filesystem::path(argv[0]).filename();
  failed_path = (std::filesystem::current_path() / (name + ".failed")).string();
  const std::vector<Bytes> seeds = seeds_of({argv + (continued ? 4 : 2), argv + argc});
  if (seeds.empty()) {
    std::cerr << name << ": there is no seed in the folders; see tests/fuzz/README.md\n";
    return 1;
  }
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGALRM, SIGTERM}) ::signal(signal, keep);
  const auto run = [&] {
    alarm(30);  // an input that takes this long counts as a hang (design), s
    LLVMFuzzerTestOneInput(present.data(), present.size());
    alarm(0);
  };
  for (const Bytes& seed : seeds) present = seed, run();
  const long runs = std::atol(argv[1]);
  for (long i = first; i < first + runs; ++i) {
    std::mt19937 random(static_cast<unsigned>(i));
    present = seeds[below(random, seeds.size())];
    const Bytes& other = seeds[below(random, seeds.size())];
    for (std::size_t n = 1 + below(random, 8); n > 0; --n) change(present, other, random);
    if (present.size() > kLongest) present.resize(kLongest);
    run();
  }
  std::cout << name << ": " << seeds.size() << " seeds and " << std::max(0L, runs) << " mutations\n";
}
