// A node of this build that renders a log, started by a test in a folder of the test.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <tactus/degradation_t.hpp>
#include <tactus/header_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"

namespace tactus::test {

struct Rendered {
  int status;
  std::string said;
};

class RenderedLog {
 public:
  explicit RenderedLog(std::string node) : node_(std::move(node)) {
    char name[] = "/tmp/tactus_rendered_XXXXXX";
    if (mkdtemp(name)) path_ = name;
  }
  ~RenderedLog() { std::filesystem::remove_all(path_); }
  RenderedLog(const RenderedLog&) = delete;
  RenderedLog& operator=(const RenderedLog&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  // The program beside this one.
  Rendered render(std::vector<std::string> words) const {
    words.insert(words.begin(), std::filesystem::read_symlink("/proc/self/exe").parent_path() / node_);
    const std::string said = file("said.txt");
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> raw;
      for (std::string& w : words) raw.push_back(w.data());
      raw.push_back(nullptr);
      dup2(open(said.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
      execv(raw[0], raw.data());
      _exit(127);
    }
    int status = -1;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes(said)};
  }
  // The trace rendered from run.lcmlog. Fails the test when rendering fails.
  std::string trace(std::vector<std::string> more = {}, const std::string& log = "run.lcmlog") const {
    std::vector<std::string> words{"--log", file(log), "--trace", file("trace.csv")};
    words.insert(words.end(), more.begin(), more.end());
    const Rendered done = render(words);
    CAPTURE(done.said);
    REQUIRE(done.status == 0);
    return bytes(file("trace.csv"));
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  static std::string bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::string node_, path_;
};

// The cells of a table, row by row, without the names.
inline std::vector<std::vector<std::string>> cells_of(const std::string& table) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(table);
  std::string line, cell;
  for (std::getline(lines, line); std::getline(lines, line);) {
    std::istringstream row(line);
    for (rows.emplace_back(); std::getline(row, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

// The message by which sync_node publishes a profile in force.
inline std::vector<std::uint8_t> in_force(const std::string& profile, header_t header) {
  degradation_t m{};
  m.header = header;
  m.generation = 1, m.pages = 1, m.text = profile, m.size = static_cast<std::int32_t>(profile.size());
  m.hash = sync::fnv1a_64(profile.data(), profile.size());
  return sync::encode(m);
}

}  // namespace tactus::test
