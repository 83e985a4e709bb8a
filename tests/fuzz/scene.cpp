// Arbitrary text read as a scene: rejected with one sentence, or a world.
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "sim_node/scene/load_sdf.h"
#include "tests/fuzz/file_of.h"

namespace {

// A cube of 0.1 m, in place of every mesh: a mesh of thousands of triangles takes most of the time of an input, and the target gltf tests
// readers of meshes.
constexpr const char* kCube =
    "v 0 0 0\nv .1 0 0\nv .1 .1 0\nv 0 .1 0\nv 0 0 .1\nv .1 0 .1\nv .1 .1 .1\nv 0 .1 .1\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

// Copies the files that scenes refer to into their folder.
bool copy_assets(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(TACTUS_SOURCE_DIR "/sim_node/scenes")) {
    const std::filesystem::path copy = folder / entry.path().filename();
    if (entry.path().extension() == ".obj")
      std::ofstream(copy) << kCube;
    else if (entry.is_regular_file() && entry.path().extension() != ".sdf")
      std::filesystem::copy_file(entry.path(), copy, error);
  }
  return !error;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf file("scene.sdf");
  static const bool beside = copy_assets(file.folder());
  if (!beside) std::abort();
  file.write(data, size);
  std::vector<std::string> warnings;
  try {
    tactus::sim::load_sdf(file.path(), warnings, {.confined = false});
  } catch (const std::runtime_error& e) {
    if (*e.what() == 0) std::abort();
  }
  return 0;
}
