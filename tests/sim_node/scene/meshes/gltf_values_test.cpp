// Every value of a valid glTF file is replaced by wrong ones: a count, an offset, an index, a list, a type.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>
#include <vector>

#include "sim_node/scene/meshes/gltf_writer.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

using Values = nlohmann::json;

MeshParts two_parts() {
  MeshParts mesh;
  for (int k = 0; k < 2; ++k) {
    MeshPart part;
    part.positions_m = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    part.normals.assign(4, {0, 0, 1});
    part.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    part.indices = {0, 1, 2, 0, 2, 3};
    part.material = k == 0 ? 0 : -1;
    mesh.parts.push_back(part);
  }
  mesh.materials.emplace_back();
  mesh.materials[0].name = "paint";
  return mesh;
}

// All values inside a document, the document itself excluded.
void collect(Values& value, std::vector<Values*>& all) {
  for (auto& [key, inside] : value.items()) {
    all.push_back(&inside);
    if (inside.is_structured()) collect(inside, all);
  }
}

Values wrong_value(const Values& right, std::mt19937& random) {
  static const std::vector<Values> kWrong{-1,     0,       1,     3,      65535, 2147483647LL, 4294967295LL, 4294967296LL, 1e300, -1e300, 0.5, nullptr,
                                          "word", "SCALAR", "VEC3", 5121, 5126,  true,         Values::array(), Values::object(), Values::array({1, "a", nullptr})};
  if (right.is_number() && random() % 2) return right.get<double>() + static_cast<double>(static_cast<int>(random() % 9) - 4);
  return kWrong[random() % kWrong.size()];
}

}  // namespace

TEST_CASE("A glTF with any wrong count, offset, index, list or type is a whole mesh or one clause") {
  SceneFile folder;
  const sync::Bytes bytes = write_gltf(two_parts(), false);
  const Values document = Values::parse(bytes.begin(), bytes.end());
  std::mt19937 random(11);
  int read = 0, refused = 0;
  for (int round = 0; round < 4000; ++round) {
    Values changed = document;
    const int changes = 1 + static_cast<int>(random() % 3);
    for (int i = 0; i < changes; ++i) {
      std::vector<Values*> all;
      collect(changed, all);
      if (all.empty()) break;
      Values& value = *all[random() % all.size()];
      if (value.is_string() && value.get_ref<const std::string&>().starts_with("data:") && random() % 2) {
        std::string data = value;  // a buffer that is cut off
        data.resize(data.size() - random() % (data.size() / 2));
        value = data;
      } else if (value.is_array() && !value.empty() && random() % 2) {
        std::swap(value[random() % value.size()], value[random() % value.size()]);
      } else {
        value = wrong_value(value, random);
      }
    }
    folder.write("a.gltf", changed.dump());
    INFO(round << ": " << changed.dump().substr(0, 2000));
    try {
      const MeshParts mesh = read_mesh_parts(folder.folder() / "a.gltf");
      for (const MeshPart& part : mesh.parts) {
        CHECK(part.normals.size() == part.positions_m.size());
        CHECK((part.texcoords.empty() || part.texcoords.size() == part.positions_m.size()));
        CHECK((part.tangents.empty() || part.tangents.size() == part.positions_m.size()));
        CHECK(part.indices.size() % 3 == 0);
        for (const int i : part.indices) REQUIRE((i >= 0 && static_cast<std::size_t>(i) < part.positions_m.size()));
        for (const Eigen::Vector3f& p : part.positions_m) REQUIRE(p.allFinite());
        CHECK((part.material >= -1 && part.material < static_cast<int>(mesh.materials.size())));
      }
      ++read;
    } catch (const std::runtime_error& e) {
      const std::string what = e.what();
      CHECK(!what.empty());
      CHECK(what.find('\n') == what.npos);
      ++refused;
    }
  }
  CHECK(read > 100);
  CHECK(refused > 1000);
}
