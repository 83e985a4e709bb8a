// Looks, shaders, passes and environment: from the scene and from mesh files to the message.
#include "sim_node/scene/extensions/tactus_looks.h"

#include <cstring>
#include <tactus/asset_ref_t.hpp>
#include <tactus/look_t.hpp>
#include <tactus/mesh_t.hpp>
#include <tactus/scene_t.hpp>

#include "tests/sim_node/support/scene_file.h"
#include "sim_node/scene/materials/pictures.h"
#include "sim_node/scene/scene_assets.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "tests/grey_png.h"

using namespace tactus;
using namespace tactus::sim;

namespace {

sync::Bytes picture(std::uint8_t red) {
  return tactus::test::png_bytes(2, 1, 8, {red, 0, 0, 0, red, 0}, PNG_COLOR_TYPE_RGB);
}
std::int64_t hash(const sync::Bytes& bytes) { return sync::fnv1a_64(bytes.data(), bytes.size()); }

const char* kShader = "void main() {}\n";
const std::string kBox = "<geometry><box><size>1 1 1</size></box></geometry>";

// A box whose visual contains `inside`, in a world that contains `outside`.
SceneFile scene(const std::string& outside, const std::string& inside) {
  return SceneFile(world(outside + "\n<model name='m'><link name='l'>\n<visual name='v'>" + kBox + inside +
                         "</visual></link></model>"),
                   {{"a.png", picture(1)},
                    {"b.png", picture(2)},
                    {"n.png", picture(3)},
                    {"own.frag", {kShader, kShader + std::strlen(kShader)}}});
}
std::string load_error(const std::string& outside, const std::string& inside = "") {
  SceneFile file = scene(outside, inside);
  return file.load_error();
}
look_t look_of(SceneFile& file) {
  const WorldDef w = file.load();
  REQUIRE(w.visuals.size() == 1);
  REQUIRE(w.visuals[0].look >= 0);
  return w.looks.at(static_cast<std::size_t>(w.visuals[0].look));
}
look_t look_of(const std::string& outside, const std::string& inside) {
  SceneFile file = scene(outside, inside);
  const look_t look = look_of(file);
  CHECK(file.warnings.empty());
  return look;
}

}  // namespace

TEST_CASE("A visual defines its shader, pictures, reflectance and uniforms") {
  const look_t look =
      look_of("",
              "<tactus:look shader='reflecting' colour_map='a.png' normal_map='n.png' reflectance='0.3' "
              "uniforms='scale 2; tint 1 0.5 0'/>");
  CHECK(look.shader == "reflecting");
  CHECK(look.colour_map == hash(picture(1)));
  CHECK(look.normal_map == hash(picture(3)));
  CHECK(look.reflectance == 0.3f);
  REQUIRE(look.uniform_count == 2);
  CHECK(look.uniforms[0].name == "scale");
  CHECK(look.uniforms[0].count == 1);
  CHECK(look.uniforms[0].values[0] == 2);
  CHECK(look.uniforms[1].count == 3);
  CHECK(look.uniforms[1].values[1] == 0.5f);
}

TEST_CASE("A look of the world can be used by name, derived and changed") {
  const std::string looks =
      "<tactus:look name='tiles' shader='textured' colour_map='a.png'/>"
      "<tactus:look name='wet' base='tiles' shader='reflecting' reflectance='0.1'/>";
  const look_t tiles = look_of(looks, "<tactus:look name='tiles'/>");
  CHECK(tiles.name == "tiles");
  CHECK(tiles.shader == "textured");
  CHECK(tiles.reflectance == 0);
  const look_t wet = look_of(looks, "<tactus:look name='wet'/>");
  CHECK(wet.colour_map == tiles.colour_map);
  CHECK(wet.shader == "reflecting");
  const look_t own = look_of(looks, "<tactus:look name='wet' colour_map='b.png' reflectance='0.5'/>");
  CHECK(own.colour_map == hash(picture(2)));
  CHECK(own.reflectance == 0.5f);
  CHECK(own.shader == "reflecting");
}

TEST_CASE("A visual without attributes has no look, and equal attributes share one look") {
  SceneFile file(world("<model name='m'><link name='l'><visual name='a'>" + kBox +
                       "<tactus:look shader='gouraud'/></visual><visual name='b'>" + kBox +
                       "<tactus:look shader='gouraud'/></visual><visual name='c'>" + kBox +
                       "</visual></link></model>"));
  const WorldDef w = file.load();
  REQUIRE(w.visuals.size() == 3);
  CHECK(w.visuals[0].look == 0);
  CHECK(w.visuals[1].look == 0);
  CHECK(w.visuals[2].look == -1);
  CHECK(w.looks.size() == 1);
}

TEST_CASE("Pictures and shininess of SDF are used, and tactus:look has precedence") {
  const std::string material =
      "<material><shininess>200</shininess><pbr><metal><albedo_map>a.png</albedo_map>"
      "<normal_map>n.png</normal_map></metal></pbr></material>";
  SceneFile file = scene("", material);
  const WorldDef w = file.load();
  CHECK(file.warnings == std::vector<std::string>{});
  CHECK(w.visuals.at(0).shininess == 200);
  CHECK(w.visuals[0].diffuse == Eigen::Vector3d::Ones());  // the map's own colours
  const look_t look = w.looks.at(0);
  CHECK(look.colour_map == hash(picture(1)));
  CHECK(look.normal_map == hash(picture(3)));
  CHECK(look.shader == "normal_mapped");  // no name given: the one that shows all attributes
  const look_t own = look_of("", "<tactus:look colour_map='b.png' normal_map=''/>" + material);
  CHECK(own.colour_map == hash(picture(2)));
  CHECK(own.normal_map == 0);
  CHECK(own.shader == "textured");
  SceneFile gone =
      scene("", "<material><pbr><metal><albedo_map>server/x.png</albedo_map></metal></pbr></material>");
  gone.load();
  REQUIRE(gone.warnings.size() == 1);
  CHECK_THAT(gone.warnings[0], Catch::Contains("server/x.png") && Catch::Contains("drawn without it"));
}

TEST_CASE(
    "Shaders, passes and environment are sent to the renderers as assets of the scene") {
  SceneFile file = scene(
      "<tactus:environment picture='a.png'/><tactus:pass shader='blur' uniforms='radius 2'/><tactus:pass "
      "shader='own'/>"
      "<tactus:shader name='own' fragment='own.frag' vertex='own.frag'/>",
      "<tactus:look shader='own' colour_map='a.png'/>");
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  const auto assets = make_assets(w);
  const auto s = sync::decode_asset<scene_t>(assets[0].bytes);
  REQUIRE(s);
  CHECK(s->environment_asset == hash(picture(1)));
  REQUIRE(s->shader_count == 1);
  CHECK(s->shaders[0].name == "own");
  CHECK(s->shaders[0].fragment_file == "own.frag");
  REQUIRE(s->pass_count == 2);
  CHECK(s->passes[0].shader == "blur");
  CHECK(s->passes[0].uniforms.at(0).values[0] == 2);
  CHECK(s->passes[1].shader == "own");
  CHECK(s->look_count == 1);
  CHECK(s->visuals.at(0).look == 0);
  int texts = 0, images = 0;
  for (const sync::Asset& a : assets) {
    texts += a.kind == asset_ref_t::SHADER, images += a.kind == asset_ref_t::IMAGE;
    if (a.kind == asset_ref_t::SHADER) CHECK(hash(a.bytes) == s->shaders[0].fragment_asset);
    if (a.kind == asset_ref_t::IMAGE) CHECK(hash(a.bytes) == s->environment_asset);
  }
  CHECK(texts == 1);  // both stages are the same text
  CHECK(images == 1);
  CHECK(s->shaders[0].vertex_asset == s->shaders[0].fragment_asset);
}

TEST_CASE(
    "A shader that belongs neither to the scene nor to visual_node causes a warning with the known names, once for each "
    "line") {
  SceneFile file = scene("<tactus:shader name='own' fragment='own.frag'/>", "<tactus:look shader='velvet'/>");
  file.load();
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.short_warnings()[0], Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("velvet") &&
                                           Catch::Contains("normal_mapped") && Catch::Contains("own"));
}

TEST_CASE("An invalid look, shader, pass or picture is rejected with its line") {
  const auto worn = [](const std::string& attributes) { return load_error("", "<tactus:look " + attributes + "/>"); };
  CHECK_THAT(worn("name='wood'"),
             Catch::StartsWith("scene.sdf:5: ") && Catch::Contains("there is none in this scene"));
  CHECK_THAT(load_error("<tactus:look name='oak' shader='phong'/>", "<tactus:look name='wood'/>"),
             Catch::Contains("there are oak"));
  CHECK_THAT(worn("colour_map='gone.png'"), Catch::Contains("gone.png\", which is not found"));
  CHECK_THAT(worn("colour_map='own.frag'"), Catch::Contains("neither PNG nor JPEG"));
  CHECK_THAT(worn("normal_map='own.frag'"), Catch::Contains("not a PNG"));
  CHECK_THAT(worn("reflectance='1.5'"), Catch::Contains("between 0 and 1"));
  CHECK_THAT(worn("reflectance='nan'"), Catch::Contains("reflectance"));
  CHECK_THAT(worn("shader='two words'"), Catch::Contains("letters"));
  CHECK_THAT(worn("colr='1'"), Catch::Contains("no attribute \"colr\""));
  CHECK_THAT(worn("uniforms='2 2'"), Catch::Contains("not a valid uniform name"));
  CHECK_THAT(worn("uniforms='gl_x 2'"), Catch::Contains("not a valid uniform name"));
  CHECK_THAT(worn("uniforms='a'"), Catch::Contains("no number"));
  CHECK_THAT(worn("uniforms='a 1 2 3 4 5'"), Catch::Contains("more than 4"));
  CHECK_THAT(worn("uniforms='a 1; a 2'"), Catch::Contains("twice"));
  CHECK_THAT(worn("uniforms='a 1e300'"), Catch::Contains("exceeds 1e6"));
  CHECK_THAT(worn("uniforms='a b'"), Catch::Contains("uniforms"));
  CHECK_THAT(load_error("<tactus:look shader='phong'/>"), Catch::Contains("\"name\""));
  CHECK_THAT(load_error("<tactus:look name='a'/><tactus:look name='a'/>"), Catch::Contains("another look has"));
  CHECK_THAT(load_error("<tactus:look name='" + std::string(65, 'a') + "'/>"), Catch::Contains("64"));
  CHECK_THAT(load_error("<tactus:look name='a' base='b'/>"), Catch::Contains("names look \"b\""));
  CHECK_THAT(load_error("\n<tactus:shader name='own' fragment='gone.frag'/>"),
             Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("not found"));
  CHECK_THAT(load_error("<tactus:shader name='own'/>"), Catch::Contains("\"fragment\""));
  CHECK_THAT(load_error("<tactus:shader name='o w n' fragment='own.frag'/>"), Catch::Contains("letters"));
  CHECK_THAT(load_error("<tactus:shader name='phong' fragment='own.frag'/>"), Catch::Contains("visual_node"));
  CHECK_THAT(load_error("<tactus:shader name='own' fragment='a.png'/>"), Catch::Contains("printable"));
  CHECK_THAT(load_error("<tactus:pass uniforms='a 1'/>"), Catch::Contains("\"shader\""));
  CHECK_THAT(load_error("<tactus:environment picture='own.frag'/>"), Catch::Contains("neither PNG nor JPEG"));
  CHECK_THAT(load_error("<tactus:environment picture='a.png'/><tactus:environment picture='b.png'/>"),
             Catch::Contains("twice"));
  CHECK_THAT(load_error("", "<tactus:display subdivide='2'/>"), Catch::Contains("only a <mesh>"));
  CHECK_THAT(load_error("", "<tactus:display subdivide='1.5'/>"), Catch::Contains("whole number"));
  CHECK_THAT(load_error("", "<tactus:display/>"), Catch::Contains("\"subdivide\""));
  SceneFile large = scene("<tactus:shader name='own' fragment='large.frag'/>", "");
  large.write("large.frag", std::string(65 << 10, ' '));
  CHECK_THAT(large.load_error(), Catch::Contains("larger than"));
}

TEST_CASE("Pictures are complete files of limited size, and JPEG is accepted only for colours") {
  const sync::Bytes png = picture(7);
  CHECK_NOTHROW(check_picture(png, PictureUse::kDirections));
  for (std::size_t size = 0; size < png.size(); ++size)
    CHECK_THROWS(check_picture(std::span(png).first(size), PictureUse::kColour));
  sync::Bytes wide = png;
  wide[16 + 2] = 0x10, wide[16 + 3] = 0x01;  // 4097 columns
  CHECK_THROWS_WITH(check_picture(wide, PictureUse::kColour), Catch::Contains("4096"));
  // The start of a JPEG of 3 x 2: an application segment, then the frame.
  sync::Bytes jpeg{0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xc0, 0, 11, 8, 0, 2, 0, 3, 1, 1, 0x11, 0};
  CHECK_NOTHROW(check_picture(jpeg, PictureUse::kColour));
  CHECK_THROWS_WITH(check_picture(jpeg, PictureUse::kDirections), Catch::Contains("not a PNG"));
  jpeg[13] = 0xff;
  CHECK_THROWS_WITH(check_picture(jpeg, PictureUse::kColour), Catch::Contains("4096"));
  CHECK_THROWS_WITH(check_picture(std::span(jpeg).first(12), PictureUse::kColour), Catch::Contains("truncated"));
}

namespace {
// Two triangles of two materials, each with its picture.
const char* kTwoObj =
    "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl red\nf 1/1 2/2 "
    "3/3\nusemtl blue\nf 2/2 1/1 4/3\n";
const char* kTwoMtl =
    "newmtl red\nKd 0.5 0.25 0.125\nmap_Kd a.png\nnewmtl blue\nKd 0.25 0.5 1\nmap_Kd b.png\nnorm n.png\n";
const std::string kMesh = "<geometry><mesh><uri>two.obj</uri></mesh></geometry>";

SceneFile two(const std::string& inside) {
  return SceneFile(
      link("<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial><collision name='c'>" + kMesh + "</collision><visual name='v'>" + kMesh + inside + "</visual>"),
      {{"a.png", picture(1)},
       {"b.png", picture(2)},
       {"n.png", picture(3)},
       {"two.obj", {kTwoObj, kTwoObj + std::strlen(kTwoObj)}},
       {"two.mtl", {kTwoMtl, kTwoMtl + std::strlen(kTwoMtl)}}});
}
}  // namespace

TEST_CASE(
    "A mesh with two materials is drawn as two parts and collides as one") {
  SceneFile file = two("");
  const WorldDef w = file.load();
  CHECK(file.warnings == std::vector<std::string>{});
  REQUIRE(w.visuals.size() == 2);
  REQUIRE(w.shapes.size() == 1);
  CHECK(w.meshes.at(static_cast<std::size_t>(w.shapes[0].mesh)).indices.size() == 6);
  CHECK(w.visuals[0].diffuse == Eigen::Vector3d(0.5, 0.25, 0.125));
  CHECK(w.visuals[1].diffuse == Eigen::Vector3d(0.25, 0.5, 1));
  const look_t red = w.looks.at(static_cast<std::size_t>(w.visuals[0].look)),
               blue = w.looks.at(static_cast<std::size_t>(w.visuals[1].look));
  CHECK(red.shader == "textured");
  CHECK(red.colour_map == hash(picture(1)));
  CHECK(red.normal_map == 0);
  CHECK(blue.shader == "normal_mapped");
  CHECK(blue.colour_map == hash(picture(2)));
  CHECK(blue.normal_map == hash(picture(3)));
  for (const VisualDef& v : w.visuals) {
    const TriangleMesh& m = w.meshes.at(static_cast<std::size_t>(v.shape.mesh));
    CHECK(m.indices.size() == 3);
    CHECK(m.texcoords.size() == m.vertices.size());
    CHECK(m.tangents.size() == m.vertices.size());
  }
  // The message has the same content.
  const auto assets = make_assets(w);
  int with_tangents = 0;
  for (const sync::Asset& a : assets) {
    if (a.kind != asset_ref_t::MESH) continue;
    const auto m = sync::decode_asset<mesh_t>(a.bytes);
    REQUIRE(m);
    if (!m->tangents.empty()) {
      ++with_tangents;
      CHECK(m->tangent_floats == m->vertex_floats / 3 * 4);
      CHECK(m->texcoord_floats == m->vertex_floats / 3 * 2);
    }
  }
  CHECK(with_tangents == 2);
}

TEST_CASE("Colours, look and pictures of SDF have precedence over those of the mesh file") {
  SceneFile coloured =
      two("<material><diffuse>1 0 0 1</diffuse></material><tactus:look colour_map='' normal_map='' "
          "shader='gouraud'/>");
  const WorldDef w = coloured.load();
  REQUIRE(w.visuals.size() == 1);  // both parts look alike now
  CHECK(w.visuals[0].diffuse == Eigen::Vector3d(1, 0, 0));
  CHECK(w.looks.at(0).shader == "gouraud");
  CHECK(w.looks.at(0).colour_map == 0);
  CHECK(w.images.empty());
}

TEST_CASE(
    "A missing picture of a mesh file causes a warning, and the mesh is drawn without it") {
  SceneFile file = two("");
  std::filesystem::remove(file.folder() / "b.png");
  const WorldDef w = file.load();
  REQUIRE(file.warnings.size() == 1);
  CHECK_THAT(file.warnings[0],
             Catch::Contains("two.obj") && Catch::Contains("b.png") && Catch::Contains("drawn without it"));
  REQUIRE(w.visuals.size() == 2);
  CHECK(w.looks.at(static_cast<std::size_t>(w.visuals[1].look)).normal_map == hash(picture(3)));
}

TEST_CASE("A visual may have a finer mesh than the collision") {
  SceneFile file = two("<tactus:display subdivide='2'/>");
  const WorldDef divided = file.load();
  CHECK(divided.meshes.at(static_cast<std::size_t>(divided.shapes.at(0).mesh)).indices.size() == 6);
  std::size_t seen = 0;
  for (const VisualDef& v : divided.visuals) {
    const TriangleMesh& m = divided.meshes.at(static_cast<std::size_t>(v.shape.mesh));
    seen += m.indices.size();
    CHECK(m.tangents.size() == m.vertices.size());
  }
  CHECK(seen == 16 * 6);
  file.write("fine.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  file.write("scene.sdf", link("<collision name='c'>" + kMesh +
                               "</collision><visual name='v'><geometry><mesh><uri>fine.obj</uri></mesh>"
                               "</geometry></visual>"));
  const WorldDef own = file.load();
  CHECK(own.visuals.at(0).shape.mesh != own.shapes.at(0).mesh);
  CHECK(own.meshes.at(static_cast<std::size_t>(own.visuals[0].shape.mesh)).vertices.size() == 4);
}
