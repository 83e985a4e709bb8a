#include "sim_node/scene/unsupported.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;

namespace {
std::vector<std::string> warnings(const std::string& inside) {
  SceneFile file(world(inside));
  file.load();
  return file.short_warnings();
}
}  // namespace

TEST_CASE("Each unsupported element causes one warning with its line and path") {
  const auto w = warnings(R"(<plugin name="p" filename="p.so"><a><b>1</b></a></plugin>
<wind><linear_velocity>1 0 0</linear_velocity></wind>
<model name="m">
<link name="l"><kinematic>true</kinematic>
<sensor name="s" type="imu"><update_rate>5</update_rate></sensor>
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry>
<surface><contact><ode><kp>1</kp></ode></contact><friction><ode><mu>1</mu><mu2>1</mu2></ode></friction></surface>
</collision></link>
<plugin name="q" filename="q.so"/></model>
<bogus/>
<tactus:bogus/>)");
  const std::string m = "/sdf/world[@name=\"w\"]/model[@name=\"m\"]", l = m + "/link[@name=\"l\"]";
  const auto expect = [](int line, const std::string& path) {
    return "scene.sdf:" + std::to_string(line) + ": " + path + " is not supported and has no effect";
  };
  CHECK_THAT(w, Catch::UnorderedEquals(std::vector<std::string>{
                    expect(3, "/sdf/world[@name=\"w\"]/plugin[@name=\"p\"]"), expect(4, "/sdf/world[@name=\"w\"]/wind"),
                    expect(6, l + "/kinematic"), expect(7, l + "/sensor[@name=\"s\"]"),
                    expect(9, l + "/collision[@name=\"c\"]/surface/contact"),
                    expect(9, l + "/collision[@name=\"c\"]/surface/friction/ode/mu2"), expect(11, m + "/plugin[@name=\"q\"]"),
                    expect(12, "/sdf/world[@name=\"w\"]/bogus"), expect(13, "/sdf/world[@name=\"w\"]/tactus:bogus")}));
}

TEST_CASE("A different step size or rate causes one warning") {
  CHECK(warnings("<physics type='ode'><max_step_size>0.001</max_step_size><real_time_factor>1</real_time_factor>"
                 "<real_time_update_rate>1000</real_time_update_rate></physics>")
            .empty());
  const auto w = warnings("<physics type='ode'>\n<max_step_size>0.004</max_step_size></physics>");
  REQUIRE(w.size() == 1);
  CHECK_THAT(w[0], Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("max_step_size = 0.004"));
}

TEST_CASE("Unsupported elements with their default values cause no warning") {
  CHECK(warnings("<model name='m'><allow_auto_disable>1</allow_auto_disable><link name='l'><enable_wind>false</enable_wind>"
                 "<kinematic>0</kinematic></link></model>")
            .empty());
}

TEST_CASE("A geometry of several shapes, of which one counts, causes one warning with its line") {
  const auto w = warnings(R"(<model name="m"><link name="l">
<collision name="c"><geometry><sphere><radius>1</radius></sphere><box><size>1 1 1</size></box><empty/></geometry></collision>
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual></link></model>)");
  REQUIRE(w.size() == 1);
  CHECK_THAT(w[0], Catch::StartsWith("scene.sdf:4: ") && Catch::EndsWith("has several shapes, of which one counts: give each a <collision> of its own"));
}

TEST_CASE("A second element of which only the first one counts causes one warning with its line") {
  const auto w = warnings(R"(<gravity>0 0 -1</gravity>
<gravity>0 0 nan</gravity>
<model name="m"><pose>0 0 1 0 0 0</pose>
<pose>0 0 2 0 0 0</pose>
<link name="l"><collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
<collision name="d"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>)");
  const auto second = [&](int line, const std::string& name) {
    return std::ranges::count_if(w, [&](const std::string& sentence) {
      return sentence.starts_with("scene.sdf:" + std::to_string(line) + ": ") && sentence.ends_with("is a second <" + name + "> and has no effect");
    });
  };
  CHECK(second(4, "gravity") == 1);
  CHECK(second(6, "pose") == 1);
  CHECK(std::ranges::none_of(w, [](const std::string& sentence) { return sentence.find("collision") != std::string::npos; }));
}
