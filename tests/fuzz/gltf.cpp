// Arbitrary bytes read as glTF or GLB: rejected with one sentence, or triangles whose vertices exist and are finite.
#include <cstdlib>
#include <stdexcept>

#include "sim_node/scene/meshes/gltf_reader.h"
#include "tests/fuzz/file_of.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf text("mesh.gltf"), binary("mesh.glb");
  const auto& file = size > 4 && data[0] == 'g' ? binary : text;
  file.write(data, size);
  try {
    static const tactus::sync::ReadableFolders readable({file.folder()});
    const auto read = tactus::sim::read_gltf(file.path(), readable);
    for (const auto& part : read.parts) {
      const auto corners = static_cast<int>(part.positions_m.size());
      for (const int index : part.indices)
        if (index < 0 || index >= corners) std::abort();
      for (const auto& p : part.positions_m)
        if (!p.allFinite()) std::abort();
      if (part.normals.size() != part.positions_m.size() ||
          part.material >= static_cast<int>(read.materials.size()))
        std::abort();
      for (const std::size_t n : {part.texcoords.size(), part.tangents.size()})
        if (n != 0 && n != part.positions_m.size()) std::abort();
    }
  } catch (const std::runtime_error& e) {
    if (*e.what() == 0) std::abort();
  }
  return 0;
}
