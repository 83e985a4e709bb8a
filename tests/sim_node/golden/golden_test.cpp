// The final state of each scene is identical to the bit to the table, for every instruction set.
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <map>

#include "sim_node/collision/layers/isa.h"
#include "tests/sim_node/support/state_hash.h"
#include "tests/source_dir.h"

using namespace tactus::sim;
using namespace tactus::sim::test;

namespace {

const std::filesystem::path kScenes = tactus::source_dir() + "/sim_node/scenes";

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

// Lines "scene hash"; a # starts a comment.
std::map<std::string, std::string> table() {
  std::map<std::string, std::string> rows;
  std::ifstream in(tactus::source_dir() + "/tests/sim_node/golden/golden_hashes.txt");
  for (std::string line; std::getline(in, line);) {
    const auto space = line.find(' ');
    if (!line.empty() && line[0] != '#' && space != std::string::npos)
      rows[line.substr(0, space)] = line.substr(space + 1);
  }
  return rows;
}

}  // namespace

TEST_CASE(
    "Every scene ends in the state of the table (update: tests/measure/golden_hashes --write)") {
  const auto golden = table();
  std::size_t scenes = 0;
  for (const auto& scene : scenes_in(kScenes)) {
    INFO(scene.stem());
    ++scenes;
    REQUIRE(golden.contains(scene.stem()));
    CHECK(hex(state_hash(scene)) == golden.at(scene.stem()));
  }
  CHECK(golden.size() == scenes);
}

TEST_CASE("Every scene ends in the same state with every instruction set") {
  int compared = 0;
  for (const auto& scene : scenes_in(kScenes)) {
    constexpr int kSteps = 120;  // of all scenes; scenes that depend on the instructions take all steps below
    const std::uint64_t baseline = state_hash(scene, {"isa=baseline"}, kSteps);
    for (const Isa isa : {Isa::kAvx2, Isa::kAvx512}) {
      if (isa > best_isa()) continue;
      INFO(scene.stem() << ", " << name_of(isa));
      CHECK(state_hash(scene, {"isa=" + std::string(name_of(isa))}, kSteps) == baseline);
      ++compared;
    }
  }
  CHECK((compared > 0 || best_isa() == Isa::kBaseline));
}

TEST_CASE("Meshes in contact end in the same state with every instruction set") {
  // The detector "layers" has separate code for each instruction set.
  const auto with = [](const std::string& isa) {
    return state_hash(kScenes / "peg_in_hole.sdf", {"detector=layers", "isa=" + isa});
  };
  const std::uint64_t baseline = with("baseline");
  // The detector is used: its other mode ends elsewhere. The detector "gaps" may end in the same state: it leaves out
  // pairs that are not contacts, which do not press.
  CHECK(baseline != state_hash(kScenes / "peg_in_hole.sdf", {"detector=layers", "contact_mode=itouch2005"}));
  if (best_isa() >= Isa::kAvx2) CHECK(with("avx2") == baseline);
  if (best_isa() >= Isa::kAvx512) CHECK(with("avx512") == baseline);
}

TEST_CASE("A state hash differs for one bit of one body and for one more step") {
  const auto scene = kScenes / "stack.sdf";
  const std::uint64_t once = state_hash(scene, {}, 60);
  CHECK(state_hash(scene, {}, 60) == once);
  CHECK(state_hash(scene, {}, 61) != once);
  CHECK(state_hash(scene, {"solver=step"}, 60) != once);
}
