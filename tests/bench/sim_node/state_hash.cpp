// Hash of each scene's state after 500 steps: the same in every build, with every instruction set.
//
//    bin/state_hash [--scenes DIR] [--steps N] [--set NAME=VALUE]...
//
// Prints a line for each scene: its name and the hash.
#include <cinttypes>
#include <cstdio>

#include "sync/node/node_options.h"
#include "tests/sim_node/support/state_hash.h"

using namespace tactus::sim;

int main(int argc, char** argv) try {
  tactus::sync::Arguments app("Prints a hash of the final state of each scene");
  std::string scenes = TACTUS_SOURCE_DIR "/sim_node/scenes";
  int steps = test::kGoldenSteps;
  std::vector<std::string> settings;
  app.add_option("--scenes", scenes, "Folder of SDF files").existing_folder();
  app.add_option("--steps", steps, "How many steps of 1 ms").range(1, 1'000'000);
  app.add_option("--set", settings, "A setting of sim_node, as NAME=VALUE");
  tactus::sync::parse_or_exit(app, "state_hash", argc, argv);
  for (const auto& scene : test::scenes_in(scenes)) {
    const std::uint64_t hash = test::state_hash(scene, settings, steps);
    std::printf("%s %016" PRIx64 "\n", scene.stem().c_str(), hash);
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "state_hash: %s\n", e.what());
  return 1;
}
