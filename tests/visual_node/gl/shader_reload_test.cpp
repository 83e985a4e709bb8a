// Shaders of a scene and of a folder, compared as pictures: a shader that does not compile never removes a picture.
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <tactus/look_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/uniform_t.hpp>
#include <thread>

#include "tests/visual_node/support/offscreen.h"
#include "visual_node/gl/shader_watch.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;
using Eigen::Vector3d;

namespace {

// A floor drawn by the shader `name`, with optional passes.
struct ShaderFixture {
  scene_t scene = floor_from_above(4);
  SceneView view;
  Renderer renderer{kWidth, kHeight, 64};
  explicit ShaderFixture(const std::string& shader, const ShaderText& scene_shader = {},
                 const std::vector<std::string>& passes = {}, const std::vector<uniform_t>& uniforms = {})
      : view(with(shader), {}, Settings{}) {
    Appearance appearance = view.appearance();
    appearance.looks[1].uniforms = uniforms;
    if (!scene_shader.name.empty()) appearance.shaders.push_back(scene_shader);
    for (const std::string& p : passes) appearance.passes.emplace_back().shader = p;
    renderer.load(view.geometries(), view.lighting(), {}, appearance);
  }
  const scene_t& with(const std::string& shader) {
    display();
    scene.lights = {spot({0, 0, 2}, 1.4, 1.5)};
    scene.visuals[0].diffuse = to_vec3f({0.8, 0.4, 0.2});
    look_t look{};
    look.name = "worn", look.shader = shader;
    scene.looks = {look};
    scene.visuals[0].look = 0;
    return scene;
  }
  Image draw() {
    const std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
    return test::draw(renderer, view.draw(poses, {}));
  }
  Vector3d middle() { return draw().at(kWidth / 2, kHeight / 2); }
};

std::string plain(const std::string& colour) {
  return "// A colour.\nvec4 shade() {\n  return vec4(" + colour + ", 1.0);\n}\n";
}
const Vector3d kRed(255, 0, 0), kGreen(0, 255, 0), kBlue(0, 0, 255);
ShaderText scene_shader(const std::string& fragment, const std::string& vertex = "") {
  return {.name = "mine",
          .fragment = fragment,
          .vertex = vertex,
          .fragment_file = "shaders/mine.frag",
          .vertex_file = vertex.empty() ? "" : "shaders/mine.vert"};
}
const std::string kBroken = "// A colour.\nvec4 shade() {\n  return nothing;\n}\n";

}  // namespace

TEST_CASE("A shader of the scene draws its surface, and an edit is visible in the next picture") {
  ShaderFixture fixture("mine", scene_shader(plain("1, 0, 0")));
  CHECK(fixture.renderer.take_warnings().empty());
  CHECK(fixture.middle() == kRed);
  fixture.renderer.set_shader_folder({{"mine.frag", plain("0, 1, 0")}});
  CHECK(fixture.renderer.take_warnings().empty());
  CHECK(fixture.middle() == kGreen);

  SECTION("a shader that does not compile is reported, and the last valid one stays") {
    fixture.renderer.set_shader_folder({{"mine.frag", kBroken}});
    const auto messages = fixture.renderer.take_warnings();
    REQUIRE(messages.size() == 1);
    CHECK_THAT(messages[0], Catch::Contains("look worn") && Catch::Contains("mine.frag:3") &&
                            Catch::Contains("the previous shader stays"));
    CHECK(fixture.middle() == kGreen);
    fixture.renderer.set_shader_folder({{"mine.frag", plain("0, 0, 1")}});
    CHECK(fixture.renderer.take_warnings().empty());
    CHECK(fixture.middle() == kBlue);
  }
  SECTION("without its file the shader of the scene returns") {
    fixture.renderer.set_shader_folder({});
    CHECK(fixture.middle() == kRed);
  }
}

TEST_CASE("Every kind of invalid source is reported in one sentence and keeps the picture") {
  const std::string nonsense = GENERATE(as<std::string>{}, "", "\0\xff\xfe", "#error no", "void main() {}",
                                        "vec4 shade() { return vec4(1) }", "vec4 other() { return vec4(1); }",
                                        "#version 450 core\nvec4 shade() { return vec4(1) + x; }",
                                        "#extension GL_nowhere : require\nvec4 shade() { return vec4(1); }");
  ShaderFixture fixture("mine", scene_shader(plain("1, 0, 0")));
  fixture.renderer.set_shader_folder({{"mine.frag", nonsense}});
  CHECK(fixture.renderer.take_warnings().size() == 1);
  CHECK(fixture.middle() == kRed);
}

TEST_CASE("A missing or invalid shader is drawn as Phong and reported once") {
  ShaderFixture phong("phong");
  const Image expected = phong.draw();
  ShaderFixture unknown("nowhere");
  auto messages = unknown.renderer.take_warnings();
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("nowhere") && Catch::Contains("gouraud") &&
                          Catch::Contains("phong is drawn instead"));
  CHECK(unknown.draw().rgba == expected.rgba);
  ShaderFixture broken("mine", scene_shader(kBroken));
  messages = broken.renderer.take_warnings();
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("mine.frag:3: error") && Catch::Contains("phong is drawn instead"));
  CHECK(broken.draw().rgba == expected.rgba);
  // No clause is about another file, and none spans two lines.
  CHECK_THAT(messages[0], !Catch::Contains("surface.glsl") && !Catch::Contains("warning") && !Catch::Contains("\n"));
  // It can be repaired while it is drawn.
  broken.renderer.set_shader_folder({{"mine.frag", plain("0, 0, 1")}});
  CHECK(broken.renderer.take_warnings().empty());
  CHECK(broken.middle() == kBlue);
}

TEST_CASE("A shader of the node can be replaced, including its lamps") {
  ShaderFixture fixture("phong");
  const Vector3d before = fixture.middle();
  fixture.renderer.set_shader_folder({{"phong.frag", plain("0, 1, 0")}});
  CHECK(fixture.middle() == kGreen);
  fixture.renderer.set_shader_folder({{"lamps.glsl", "broken"}});
  CHECK_THAT(fixture.renderer.take_warnings().front(), Catch::Contains("lamps.glsl:1"));
  CHECK(fixture.middle() == kGreen);
  fixture.renderer.set_shader_folder({});
  CHECK(fixture.middle() == before);
}

TEST_CASE("A vertex shader moves its surface") {
  // Moved up by 2 m: from 4 m the floor looks twice as large.
  ShaderFixture raised("mine", scene_shader(plain("0, 1, 0"), "vec3 moved(vec3 at) { return at + vec3(0.0, 3.0, 0.0); }\n"));
  CHECK(raised.renderer.take_warnings().empty());
  // The floor ended 5 m to the left, at +y; 2.2 m are visible to each side. Moved by 3 m its right edge is 2 m to
  // the right.
  const Image image = raised.draw();
  CHECK(image.at(kWidth / 2, kHeight / 2) == kGreen);
  CHECK(image.at(kWidth / 2 + static_cast<int>(1.95 * scale_px(4)), kHeight / 2) == kGreen);
  CHECK(image.at(kWidth / 2 + static_cast<int>(2.05 * scale_px(4)), kHeight / 2) == Vector3d::Zero());
  raised.renderer.set_shader_folder({{"mine.vert", "vec3 moved(vec3 at) { return at }"}});
  CHECK_THAT(raised.renderer.take_warnings().front(), Catch::Contains("mine.vert:1"));
}

TEST_CASE("An invalid pass keeps its previous version, and a missing one is omitted") {
  ShaderFixture fixture("phong", scene_shader(plain("0, 0, 1")), {"mine", "nowhere"});
  const auto messages = fixture.renderer.take_warnings();
  REQUIRE(messages.size() == 1);
  CHECK_THAT(messages[0], Catch::Contains("pass nowhere") && Catch::Contains("left out"));
  CHECK(fixture.middle() == kBlue);
  fixture.renderer.set_shader_folder({{"mine.frag", kBroken}});
  CHECK_THAT(fixture.renderer.take_warnings().front(),
             Catch::Contains("mine.frag:3") && Catch::Contains("the previous shader stays"));
  CHECK(fixture.middle() == kBlue);
  fixture.renderer.set_shader_folder({{"mine.frag", plain("1, 0, 0")}});
  CHECK(fixture.middle() == kRed);
}

TEST_CASE("Uniforms are set by name, and an unsuitable one is reported") {
  uniform_t tint{};
  tint.name = "tint", tint.count = 3, tint.values[1] = 1;
  const std::string tinted = "uniform vec3 tint;\nvec4 shade() { return vec4(tint, 1.0); }\n";
  ShaderFixture fixture("mine", scene_shader(tinted), {}, {tint});
  CHECK(fixture.renderer.take_warnings().empty());
  CHECK(fixture.middle() == kGreen);
  SECTION("the uniform has another type") {
    fixture.renderer.set_shader_folder(
        {{"mine.frag", "uniform float tint;\nvec4 shade() { return vec4(tint, 0.0, 1.0, 1.0); }\n"}});
    CHECK_THAT(fixture.renderer.take_warnings().at(0),
               Catch::Contains("uniform tint") && Catch::Contains("not a vec3"));
    CHECK(fixture.middle() == kBlue);
  }
  SECTION("the uniform has another name") {
    fixture.renderer.set_shader_folder({{"mine.frag", plain("0, 0, 1")}});
    CHECK_THAT(fixture.renderer.take_warnings().at(0), Catch::Contains("has no uniform tint"));
    CHECK(fixture.middle() == kBlue);
  }
  SECTION("a uniform without effect is not reported") {
    fixture.renderer.set_shader_folder({{"mine.frag", "uniform vec3 tint;\n" + plain("0, 0, 1")}});
    CHECK(fixture.renderer.take_warnings().empty());
  }
}

TEST_CASE("Only shader files of limited size are read, and a missing folder is empty") {
  const auto folder = std::filesystem::temp_directory_path() / "tactus_shader_folder_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "folder.frag");
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  write("a.frag", "a"), write("b.vert", "b"), write("c.glsl", "c"), write("d.txt", "d"),
      write("e.frag", std::string(65537, 'e'));
  const ShaderFolder files = read_shader_folder(folder);
  CHECK(files == ShaderFolder{{"a.frag", "a"}, {"b.vert", "b"}, {"c.glsl", "c"}});
  for (int i = 0; i < 100; ++i) write("n" + std::to_string(i) + ".frag", "n");
  CHECK(read_shader_folder(folder).size() <= 64);
  CHECK(read_shader_folder(folder / "nowhere").empty());
  std::filesystem::remove_all(folder);
}

TEST_CASE("A watched folder is read once, and again when it changes") {
  const auto folder = std::filesystem::temp_directory_path() / "tactus_shader_watch_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.frag") << "one";
  ShaderWatch watch(folder);
  const auto next = [&] {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);  // generous: this test is not about time
    while (std::chrono::steady_clock::now() < until) {
      if (auto files = watch.take_change()) return *files;
      std::this_thread::yield();
    }
    return ShaderFolder{};
  };
  CHECK(next() == ShaderFolder{{"a.frag", "one"}});
  CHECK_FALSE(watch.take_change());
  std::ofstream(folder / "a.frag") << "two";
  // An editor may write in two steps.
  ShaderFolder seen = next();
  while (!seen.empty() && seen.begin()->second != "two") seen = next();
  CHECK(seen == ShaderFolder{{"a.frag", "two"}});
  CHECK_FALSE(ShaderWatch("").take_change());
  std::filesystem::remove_all(folder);
}
