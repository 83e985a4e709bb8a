// Scene files as worlds for the laws of mechanics. The first comment of a file may give its duration (seconds 0.5) and
// its expectation (expect static, rest or momentum), and say that bodies touch or overlap at the start (touching).
#pragma once

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "sim_node/scene/load_sdf.h"
#include "tests/sim_node/support/random_worlds.h"

namespace tactus::sim::test {

inline RandomWorld world_of_file(const std::string& file) {
  std::vector<std::string> warnings;
  RandomWorld w;
  w.world = load_sdf(file, warnings);
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  std::istringstream lines(text.substr(0, text.find("-->")));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what, which;
    words >> what;
    if (what == "seconds") words >> w.seconds;
    if (what == "touching") w.touching = true;
    if (what != "expect") continue;
    words >> which;
    w.expectation = which == "momentum"                     ? Expectation::kMomentum
                    : which == "static" || which == "rest" ? Expectation::kRests
                                                            : Expectation::kMoves;
  }
  return w;
}

}  // namespace tactus::sim::test
