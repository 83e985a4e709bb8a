// Recovery from the loss of the graphics device. The loss is injected by a display that works and reports that it
// is lost.
#include "visual_node/gl/render_output.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <tactus/scene_t.hpp>

#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::visual;
using namespace tactus::test;

namespace {

sync::HostTime at_s(double s) { return sync::HostTime{sync::from_seconds(s)}; }

// The shared context of these tests, which stays current.
struct FakeDisplay : Display {
  std::string& loss;
  bool window;
  FakeDisplay(std::string& t, bool w) : loss(t), window(w) { description_ = window ? "a window" : "no window"; }
  void show(unsigned, int, int, bool) override {}
  bool closed() override { return false; }
  std::string loss_reason() override { return loss; }
  bool server_gone() override { return window && !loss.empty(); }
  bool has_screen() const override { return window; }
};

struct OutputFixture {
  std::string loss;
  int opened = 0, max_opens = 1000;
  Settings settings;
  scene_t scene = floor_from_above(2);
  SceneView view{scene, {}, settings, {}};
  DrawList list = view.draw(std::vector<Eigen::Isometry3d>{to_eigen(scene.bodies[0].pose)}, {});

  MakeDisplay make() {
    return [this](const Settings&, bool window) -> std::unique_ptr<Display> {
      if (opened++ >= max_opens) throw std::runtime_error("no OpenGL 3.3 context, tried nothing");
      display();
      loss.clear();
      return std::make_unique<FakeDisplay>(loss, window);
    };
  }
  std::vector<std::uint8_t> picture(RenderOutput& output) {
    output.draw_scene(list, {});
    output.draw_flashes_and_overlay(list);
    std::vector<std::uint8_t> rgba(
        static_cast<std::size_t>(output.picture().width() * output.picture().height() * 4));
    output.picture().read(rgba);
    return rgba;
  }
};

}  // namespace

TEST_CASE("A lost device is opened again and draws the scene as before") {
  OutputFixture f;
  RenderOutput output(f.settings, false, f.make());
  output.load(f.view, f.list, f.settings);
  const auto before = f.picture(output);
  REQUIRE(*std::max_element(before.begin(), before.end()) > 0);
  CHECK(output.recover(at_s(1), &f.view, f.list).empty());
  CHECK(f.opened == 1);

  f.loss = "the graphics device was reset";
  CHECK(output.recover(at_s(2), &f.view, f.list) == "the graphics device was reset; drawing continues with no window");
  CHECK(f.opened == 2);
  CHECK(f.picture(output) == before);
  CHECK(output.recover(at_s(3), &f.view, f.list).empty());
}

TEST_CASE("A device that is lost before the first scene is opened again") {
  OutputFixture f;
  RenderOutput output(f.settings, false, f.make());
  f.loss = "the graphics device was reset";
  CHECK_FALSE(output.recover(at_s(2), nullptr, {}).empty());
  CHECK(output.picture().width() == f.settings.width);
}

TEST_CASE("A window without a display server is closed, and drawing continues without it") {
  OutputFixture f;
  RenderOutput output(f.settings, true, f.make());
  REQUIRE(output.display().has_screen());
  f.loss = "the display server of the window is gone";
  CHECK_THAT(output.recover(at_s(1), nullptr, {}),
             Catch::Contains("display server") && Catch::Contains("no window"));
  CHECK_FALSE(output.display().has_screen());
}

TEST_CASE(
    "A device that is lost more than three times in a minute ends the node with one sentence") {
  OutputFixture f;
  RenderOutput output(f.settings, false, f.make());
  double now_s = 0;
  for (int i = 0; i < 20; ++i) {
    f.loss = "the graphics device was reset";
    CHECK_FALSE(output.recover(at_s(now_s += 21), nullptr, {}).empty());  // three a minute
  }
  now_s += 1000;
  for (std::size_t i = 0; i < RenderOutput::kMaxLosses; ++i) {
    f.loss = "the graphics device was reset";
    CHECK_FALSE(output.recover(at_s(now_s += 1), nullptr, {}).empty());
  }
  f.loss = "the graphics device was reset";
  CHECK_THROWS_WITH(output.recover(at_s(now_s), nullptr, {}), Catch::Contains("4 times in a minute"));
}

TEST_CASE("The error for a device that cannot be opened again has the reason and the attempts") {
  OutputFixture f;
  f.max_opens = 1;
  RenderOutput output(f.settings, false, f.make());
  f.loss = "the graphics device was reset";
  CHECK_THROWS_WITH(output.recover(at_s(1), nullptr, {}), Catch::Contains("was reset") &&
                                                             Catch::Contains("cannot be opened again") &&
                                                             Catch::Contains("tried nothing"));
}

TEST_CASE("An OpenGL error in a working context does not count as a lost device") {
  CHECK(display().loss_reason().empty());
  Settings settings;
  Renderer renderer(64, 64, settings.shadow_size);
  CHECK(renderer.wait());
  CHECK(display().loss_reason().empty());
}

TEST_CASE("The first picture of a world has the quality at which its pictures are fast enough") {
  for (const auto& [picture_ms, step] : {std::pair{1.0, 0}, std::pair{12.0, 0}, std::pair{14.0, 3}, std::pair{2000.0, 3}}) {
    OutputFixture f;
    RenderOutput output(f.settings, false, f.make());
    output.load(f.view, f.list, f.settings);
    sync::HostTime now = at_s(1);  // it moves by the time of a picture at each look
    int meanwhile = 0;
    output.start_quality(f.list, [&, ms = picture_ms] { return now += sync::from_seconds(1e-3 * ms); }, [&] { ++meanwhile; });
    INFO(picture_ms << " ms");
    CHECK(output.quality().step() == step);
    CHECK(meanwhile > 0);
    CHECK(meanwhile <= RenderOutput::kTimings * QualityControl::steps());
  }
  OutputFixture f;
  f.settings.quality = "1";
  RenderOutput output(f.settings, false, f.make());
  output.load(f.view, f.list, f.settings);
  sync::HostTime now = at_s(1);
  output.start_quality(f.list, [&] { return now += sync::from_seconds(0.02); });
  CHECK(output.quality().step() == 1);
}
