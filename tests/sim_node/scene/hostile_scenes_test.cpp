// Scenes of a stranger: they read no file outside their folder, and a small one cannot take large amounts of memory.
#include <sys/resource.h>
#include <sys/stat.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "sim_node/scene/meshes/gltf_document.h"
#include "sim_node/scene/scene_folders.h"
#include "tests/grey_png.h"
#include "tests/sim_node/support/scene_file.h"

using namespace tactus;
using namespace tactus::sim;
using Catch::Contains;
using Catch::StartsWith;

namespace {

constexpr std::string_view kOutside = "is hidden or outside the folder of the scene";
const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

double memory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::string include(const std::string& uri, const std::string& name = "") {
  return "<include><uri>" + uri + "</uri>" + (name.empty() ? "" : "<name>" + name + "</name>") + "</include>\n";
}

std::string model_file(const std::string& name, const std::string& inside) {
  return "<sdf version='1.9'>\n<model name='" + name + "'><link name='l'/>\n" + inside + "</model>\n</sdf>\n";
}

// A scene in the folder "scene" of a folder that holds other files, of every kind that a scene can name.
struct Stranger {
  SceneFile file;
  Stranger() {
    const auto png = tactus::test::png_bytes(2, 2, 8, {0, 255, 255, 0});
    const std::string picture(png.begin(), png.end());
    for (const std::string folder : {"", "scene/", "scene/.hidden/"}) {
      file.write(folder + "m.obj", kTriangle);
      file.write(folder + "p.png", picture);
      file.write(folder + "s.frag", "void surface(inout Surface s) {}\n");
      file.write(folder + "ball.sdf", model_file("ball", ""));
      file.write(folder + "motion.csv", "time_s,x_m,y_m,z_m\n0,0,0,0\n");
      file.write(folder + "modes.csv", "frequency_Hz,damping_1_s,amplitude\n440,3,1\n");
      file.write(folder + "profile.xml", "<profile><degrade modality='audio' delay='10ms'/></profile>");
    }
    std::filesystem::create_symlink("../m.obj", file.folder() / "scene/link.obj");
    std::filesystem::create_symlink("..", file.folder() / "scene/up");
  }
  std::string error(const std::string& text, const LoadOptions& options = {.confined = false}) {
    file.write("scene/s.sdf", text);
    std::vector<std::string> warnings;
    try {
      load_sdf(file.folder() / "scene/s.sdf", warnings, options);
      return "";
    } catch (const std::runtime_error& e) {
      return e.what();
    }
  }
};

std::string mesh(const std::string& uri) { return link(collision("<mesh><uri>" + uri + "</uri></mesh>")); }

}  // namespace

TEST_CASE("A scene reads no file outside its folder, by any element, path or link") {
  Stranger stranger;
  const std::string above = stranger.file.folder().string() + "/";
  using Make = std::function<std::string(const std::string& folder)>;
  const std::string oak = "<tactus:material name='x' base='oak' ";
  const std::pair<const char*, Make> elements[] = {
      {"mesh", [](auto& f) { return mesh(f + "m.obj"); }},
      {"include", [](auto& f) { return world(include(f + "ball.sdf")); }},
      {"height map", [](auto& f) { return link(collision("<heightmap><uri>" + f + "p.png</uri><size>1 1 1</size></heightmap>")); }},
      {"bump", [&](auto& f) { return world(oak + "bump='" + f + "p.png' bump_size='1m 1m' bump_height='1mm'/>"); }},
      {"friction", [&](auto& f) { return world(oak + "friction_map='" + f + "p.png' friction_size='1m 1m' friction_factors='0 1'/>"); }},
      {"modes", [&](auto& f) { return world(oak + "modes='" + f + "modes.csv'/>"); }},
      {"shader", [](auto& f) { return world("<tactus:shader name='s' fragment='" + f + "s.frag'/>"); }},
      {"colour map", [](auto& f) { return world("<tactus:look name='l' colour_map='" + f + "p.png'/>"); }},
      {"environment", [](auto& f) { return world("<tactus:environment picture='" + f + "p.png'/>"); }},
      {"profile", [](auto& f) { return world("<tactus:profile file='" + f + "profile.xml'/>"); }},
      {"motion", [](auto& f) { return world("<tactus:tool name='h' device='playback:" + f + "motion.csv'/>"); }},
      {"tool mesh", [](auto& f) {
         return world("<tactus:tool name='h' shape='mesh' scale='0.1' mesh='" + f +
                      "m.obj'><tactus:waypoint time='0s' position='0 0 0'/></tactus:tool>");
       }}};
  for (const auto& [name, make] : elements) {
    CAPTURE(name);
    // Every way out for one element; the most usual one for the others.
    std::vector<std::string> outside{"../"};
    if (std::string(name) == "mesh" || std::string(name) == "include")
      outside = {"../", above, "up/", "file://" + above, "../scene/../", ".hidden/"};
    for (const std::string& folder : outside) {
      CAPTURE(folder);
      CHECK_THAT(stranger.error(make(folder)), Contains("s.sdf:") && Contains(std::string(kOutside)));
    }
    for (const std::string& folder : {std::string(), above + "scene/"}) {
      CAPTURE(folder);
      CHECK(stranger.error(make(folder)) == "");
    }
    // The user may name a folder.
    CHECK(stranger.error(make(above), {.folders = {stranger.file.folder()}, .confined = false}) == "");
  }
  CHECK_THAT(stranger.error(mesh("link.obj")), Contains(std::string(kOutside)));
}

TEST_CASE("The environment names folders of scenes too, and they are searched") {
  unsetenv("GZ_SIM_RESOURCE_PATH");
  setenv("TACTUS_SCENE_FOLDERS", "/a::/b", 1);
  CHECK(scene_folders({"/c"}) == std::vector<std::filesystem::path>{"/c", "/a", "/b"});
  SceneFile models;
  setenv("GZ_SIM_RESOURCE_PATH", ("/no/such/folder:" + models.folder().string() + "::/a").c_str(), 1);
  CHECK(scene_folders({"/c"}) == std::vector<std::filesystem::path>{"/c", "/a", "/b", models.folder()});
  unsetenv("TACTUS_SCENE_FOLDERS");
  unsetenv("GZ_SIM_RESOURCE_PATH");
  Stranger stranger;
  models.write("chair/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>");
  models.write("chair/model.sdf", model_file("chair", ""));
  CHECK_THAT(stranger.error(world(include("model://chair"))), Contains("is not found"));
  CHECK(stranger.error(world(include("model://chair")), {.folders = {models.folder()}, .confined = false}) == "");
}

TEST_CASE("A model.config outside of the folder of a scene is not read, wherever it leads") {
  Stranger stranger;
  stranger.file.write("chair/model.config", "<model><sdf version='1.9'>../scene/ball.sdf</sdf></model>");
  stranger.file.write("scene/.hidden/model.config", "<model><sdf version='1.9'>../ball.sdf</sdf></model>");
  for (const std::string& uri : {std::string("../chair"), std::string(".hidden"), std::string("up/chair"), (stranger.file.folder() / "chair").string()})
    CHECK_THAT(stranger.error(world(include(uri))), Contains("s.sdf:3: ") && Contains(std::string(kOutside)));
  CHECK(stranger.error(world(include("../chair")), {.folders = {stranger.file.folder()}, .confined = false}) == "");
}

TEST_CASE("The files of a mesh stay below the folder of the scene") {
  Stranger stranger;
  stranger.file.write("m.mtl", "newmtl a\nKd 1 0 0\n");
  stranger.file.write("b.bin", std::string(36, '\0'));
  stranger.file.write("scene/out.obj", "mtllib ../m.mtl\nusemtl a\n" + kTriangle);
  CHECK_THAT(stranger.error(mesh("out.obj")), Contains("names \"m.mtl\"") && Contains(std::string(kOutside)));
  stranger.file.write("scene/out.gltf", R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[]}],"buffers":[{"byteLength":36,"uri":"..%2Fb.bin"}]})");
  CHECK_THAT(stranger.error(mesh("out.gltf")), Contains("b.bin") && Contains(std::string(kOutside)));
  // A picture is left out with a warning, as one that is missing.
  stranger.file.write("scene/look.mtl", "newmtl a\nmap_Kd ../p.png\n");
  stranger.file.write("scene/look.obj", "mtllib look.mtl\nusemtl a\nvt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n");
  stranger.file.write("scene/s.sdf", link("<visual name='v'><geometry><mesh><uri>look.obj</uri></mesh></geometry></visual>"));
  std::vector<std::string> warnings;
  const WorldDef w = load_sdf(stranger.file.folder() / "scene/s.sdf", warnings);
  CHECK(w.images.empty());
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("../p.png") && Contains(std::string(kOutside)));
}

TEST_CASE("A scene, an include and a model.config that are pipes or devices are rejected at once") {
  SceneFile file;
  REQUIRE(mkfifo((file.folder() / "scene.sdf").c_str(), 0600) == 0);
  CHECK_THAT(file.load_error(), Contains("scene \"scene.sdf\"") && Contains("not a regular file"));
  std::vector<std::string> warnings;
  CHECK_THROWS_WITH(load_sdf("/dev/zero", warnings), Contains("not a regular file"));
  std::filesystem::remove(file.folder() / "scene.sdf");
  REQUIRE(mkfifo((file.folder() / "part.sdf").c_str(), 0600) == 0);
  file.write("scene.sdf", world(include("part.sdf")));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:3: ") && Contains("part.sdf"));
  std::filesystem::create_directory(file.folder() / "part");
  REQUIRE(mkfifo((file.folder() / "part/model.config").c_str(), 0600) == 0);
  file.write("scene.sdf", world(include("model://part")));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:3: ") && Contains("is not found"));
  // An include in another place is no way around the checks.
  file.write("scene.sdf", link(include("/dev/zero")));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:5: ") && Contains("<include> is inside <link>"));
}

TEST_CASE("Includes that multiply are counted before they are expanded") {
  SceneFile file;
  const double before_MB = memory_MB();
  std::string tenfold;
  const auto text_of = [](int level) {
    std::string inside;
    for (int i = 0; i < 10; ++i) inside += include("l" + std::to_string(level + 1) + ".sdf", "m" + std::to_string(i));
    return inside;
  };
  file.write("scene.sdf", world(text_of(0)));
  for (int level = 1; level < 10; ++level) file.write("l" + std::to_string(level) + ".sdf", model_file("m", text_of(level)));
  file.write("l10.sdf", model_file("m", ""));
  CHECK_THAT(file.load_error(), Contains(".sdf:") && Contains("the copies of included files have more than 1000000 elements"));
  CHECK(memory_MB() - before_MB < 100);
}

TEST_CASE("Includes and models that are nested without end, or very deep, are one sentence") {
  SceneFile file;
  // A chain of files.
  for (int i = 0; i < 200; ++i)
    file.write("c" + std::to_string(i) + ".sdf", model_file("m", include("c" + std::to_string(i + 1) + ".sdf")));
  file.write("c200.sdf", model_file("m", ""));
  file.write("scene.sdf", world(include("c0.sdf")));
  CHECK_THAT(file.load_error(), StartsWith("c30.sdf:3: ") && Contains("more than 32 files include each other"));
  // A circle of three files.
  for (int i = 0; i < 3; ++i)
    file.write("c" + std::to_string(i) + ".sdf", model_file("m", include("c" + std::to_string((i + 1) % 3) + ".sdf")));
  CHECK_THAT(file.load_error(), StartsWith("c2.sdf:3: ") && Contains("circular"));
  // Nested models in one file, and over several files.
  const auto nested = [](int levels, const std::string& inside) {
    std::string text = inside;
    for (int i = 0; i < levels; ++i)
      text = "<model name='n" + std::to_string(levels - i) + "'><link name='l'/>" + text + "</model>";
    return text;
  };
  file.write("scene.sdf", world(nested(5000, "")));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:3: ") && Contains("XML"));
  for (int i = 0; i < 4; ++i)
    file.write("c" + std::to_string(i) + ".sdf", model_file("m", nested(30, i < 3 ? include("c" + std::to_string(i + 1) + ".sdf") : "")));
  file.write("scene.sdf", world(include("c0.sdf")));
  CHECK_THAT(file.load_error(), StartsWith("c") && Contains("nested deeper than 100 levels"));
  file.write("scene.sdf", world(nested(20, "")));
  CHECK(file.load_error() == "");
}

TEST_CASE("One height map or mesh in many sizes is counted for each size") {
  SceneFile file;
  const double before_MB = memory_MB();
  const auto png = tactus::test::png_bytes(4097, 4097, 8, std::vector<std::uint8_t>(std::size_t{4097} * 4097));
  file.write("flat.png", {png.begin(), png.end()});
  std::string links;
  for (int i = 1; i < 40; ++i)
    links += "<link name='l" + std::to_string(i) + "'>" +
             collision("<heightmap><uri>flat.png</uri><size>1 1 " + std::to_string(i) + "</size></heightmap>") + "</link>\n";
  file.write("scene.sdf", world("<model name='m'><static>true</static>\n" + links + "</model>"));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:6: ") && Contains("height maps of the scene have more than"));
  CHECK(memory_MB() - before_MB < 700);

  std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n";
  for (int i = 0; i < 300'000; ++i) faces += "f 1//1 2//1 3//1\n";
  file.write("many.obj", faces);
  links.clear();
  for (int i = 1; i < 200; ++i)
    links += "<link name='l" + std::to_string(i) + "'>" +
             collision("<mesh><uri>many.obj</uri><scale>1 1 " + std::to_string(i) + "</scale></mesh>") + "</link>\n";
  file.write("scene.sdf", world("<model name='m'><static>true</static>\n" + links + "</model>"));
  CHECK_THAT(file.load_error(), StartsWith("scene.sdf:10: ") && Contains("the scene has more than 2000000 triangles"));
}

TEST_CASE("Thousands of unsupported elements are a thousand warnings") {
  SceneFile file;
  std::string inside;
  for (int i = 0; i < 5000; ++i) inside += "<unknown_thing/>\n";
  file.write("scene.sdf", world(inside));
  CHECK(file.load_error() == "");
  REQUIRE(file.warnings.size() == 1001);
  CHECK_THAT(file.warnings.back(), Contains("more than 1000 warnings"));
}

TEST_CASE("A scene that is cut off, or damaged, is a world or one sentence") {
  const std::string whole = world(
      "<tactus:material name='x' base='oak'/>\n<model name='m'><pose>0 0 1 0 0 0</pose><link name='l'><inertial><mass>1</mass>"
      "</inertial>" +
      collision("<box><size>1 1 1</size></box>") +
      "</link></model>\n<tactus:tool name='h' radius='8mm'><tactus:waypoint time='0s' position='0 0 1'/></tactus:tool>" +
      include("ball.sdf"));
  SceneFile file;
  file.write("ball.sdf", model_file("ball", ""));
  const auto load = [&](const std::string& text) {
    file.write("scene.sdf", text);
    const std::string error = file.load_error();
    REQUIRE(error.find('\n') == std::string::npos);
    return error;
  };
  REQUIRE(load(whole) == "");
  for (std::size_t size = 0; size < whole.size() - 8; size += 3) REQUIRE(load(whole.substr(0, size)) != "");
  std::mt19937 random(3);
  const std::string pieces[] = {"nan", "-1", "1e999", "inf", "0", "<model name='m'>", "<include>", "\"", "'", "<", ">", "&", "&#0;", "\x1b[2J"};
  for (int i = 0; i < 100; ++i) {
    std::string changed = whole;
    for (int k = 0; k <= i % 3; ++k) {
      const std::size_t at = random() % changed.size();
      if (random() % 2 == 0)
        changed[at] = static_cast<char>(random());
      else
        changed.replace(at, random() % 4, pieces[random() % std::size(pieces)]);
    }
    file.write("scene.sdf", changed);
    const std::string error = file.load_error();
    INFO(changed);
    CHECK(error.size() < 2000);
  }
}
