#include "sim_node/scene/materials/height_image.h"

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/shapes.h"
#include "sim_node/model/triangles.h"
#include "tests/grey_png.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
void write_png(const SceneFile& file, int columns, int rows, int bits, int type, const std::vector<std::uint8_t>& samples) {
  const auto bytes = tactus::test::png_bytes(columns, rows, bits, samples, type);
  file.write("h.png", {bytes.begin(), bytes.end()});
}
std::string heightmap(const std::string& more = "") {
  return model("<static>true</static><link name='l'><collision name='c'><geometry>\n<heightmap><uri>h.png</uri><size>2 1 0.5</size>"
               "<pos>0 0 3</pos>" + more + "</heightmap></geometry></collision></link>");
}
}  // namespace

TEST_CASE("In a grey picture white is the full height, and the top row is at +y") {
  SceneFile file(heightmap());
  write_png(file, 3, 2, 8, PNG_COLOR_TYPE_GRAY, {255, 0, 0, 0, 0, 51});
  const WorldDef w = file.load();
  REQUIRE(w.heightfields.size() == 1);
  const Heightfield& h = w.heightfields[0];
  CHECK(w.shapes[0].kind == ShapeKind::kHeightfield);
  CHECK(h.columns == 3);
  CHECK(h.rows == 2);
  CHECK(h.size_m == Vector3d(2, 1, 0.5));
  CHECK(h.centre_m == Vector3d(0, 0, 3));
  CHECK(h.heights_m[2] == Approx(0.1));  // bottom right: y = -1/2
  CHECK(h.heights_m[3] == Approx(0.5));  // top left
  const TriangleMesh mesh = triangulate(h, 100);
  CHECK(mesh.vertices.size() == 6);
  CHECK((mesh.vertices[3] - Vector3d(-1, 0.5, 3.5)).norm() < 1e-9);
  CHECK(mesh.indices.size() == 12);
  for (const Vector3d& n : mesh.normals) CHECK(n.z() > 0);
  CHECK((bounds(w, w.shapes[0]).max() - Vector3d(1, 0.5, 3.5)).norm() < 1e-9);
}

TEST_CASE("Sixteen-bit pictures keep their resolution") {
  SceneFile file(heightmap());
  write_png(file, 2, 2, 16, PNG_COLOR_TYPE_GRAY, {0, 0, 0, 1, 0x80, 0, 0xff, 0xff});
  const WorldDef w = file.load();
  CHECK(w.heightfields[0].heights_m[1] == Approx(0.5));
  CHECK(w.heightfields[0].heights_m[3] == Approx(0.5 / 65535));
  CHECK(w.heightfields[0].heights_m[0] == Approx(0.5 * 32768 / 65535));
}

TEST_CASE("A large height map is reduced for display and keeps its edges") {
  Heightfield h;
  h.columns = h.rows = 1000;
  h.size_m = {1, 1, 1};
  h.heights_m.assign(1'000'000, 0);
  const TriangleMesh mesh = triangulate(h, 100);
  CHECK(mesh.vertices.size() == 10'000);
  CHECK((bounds(mesh, Eigen::Isometry3d::Identity()).sizes() - Vector3d(1, 1, 0)).norm() < 1e-12);
}

TEST_CASE("A picture that is not a height map is rejected with its line") {
  SceneFile file(heightmap());
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("not found"));
  file.write("h.png", "no picture at all");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("not a PNG"));
  write_png(file, 2, 2, 8, PNG_COLOR_TYPE_RGB, std::vector<unsigned char>(12));
  CHECK_THAT(file.load_error(), Catch::Contains("grey"));
  write_png(file, 1, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 0});
  CHECK_THAT(file.load_error(), Catch::Contains("samples"));
  // Cut in the middle of its data.
  write_png(file, 100, 100, 8, PNG_COLOR_TYPE_GRAY, std::vector<unsigned char>(10'000, 7));
  std::filesystem::resize_file(file.folder() / "h.png", 60);
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("cannot be read"));
}
