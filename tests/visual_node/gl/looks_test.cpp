// Lamps and materials: each pixel against the published formulas.
#include <catch2/catch.hpp>
#include <numbers>
#include <tactus/body_def_t.hpp>
#include <tactus/light_def_t.hpp>
#include <tactus/look_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/shape_def_t.hpp>
#include <tactus/visual_def_t.hpp>

#include "tests/visual_node/support/reference.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::test::reference;
using sync::Raster;

namespace {

light_def_t lamp_of(int kind) {
  light_def_t lamp = spot({0.2, 1.1, 1.4}, 0.5, 1.3);
  lamp.kind = static_cast<std::int8_t>(kind);
  lamp.direction = to_vec3((Vector3d(1.9, 0.1, 0) - Vector3d(0.2, 1.1, 1.4)).normalized());
  lamp.diffuse = to_vec3f({0.9, 0.7, 0.5});
  lamp.specular = to_vec3f({0.5, 0.6, 0.7});
  lamp.attenuation_constant = 0.3f, lamp.attenuation_linear = 0.1f, lamp.attenuation_quadratic = 0.2f;
  lamp.falloff = 1.5f;
  lamp.intensity = 0.8f;
  lamp.casts_shadow = 0;
  return lamp;
}

// A shape before the eye with all colour components, in the light of one lamp.
scene_t lit(int shape, int lamp) {
  scene_t scene = empty_scene();
  add_visual(scene, add_body(scene, {2, 0.1, 0}), shape, {0.7, 0.7, 0.7});
  visual_def_t& v = scene.visuals[0];
  v.diffuse = to_vec3f({0.7, 0.4, 0.2});
  v.specular = to_vec3f({0.4, 0.3, 0.5});
  v.ambient = to_vec3f({0.6, 0.5, 0.9});
  v.emissive = to_vec3f({0.01, 0, 0.03});
  v.shininess = 20;
  scene.ambient = to_vec3f({0.06, 0.07, 0.08});
  // Rotated, so that no axis of the shape is a world axis.
  scene.visuals[0].shape.pose =
      to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(0.5, Vector3d(1, 2, -1).normalized()) *
                                Eigen::AngleAxisd(shape == shape_def_t::PLANE ? -1.5 : 0, Vector3d::UnitY())));
  scene.lights = {lamp_of(lamp)};
  return scene;
}

void set_look(scene_t& scene, const std::string& shader, std::int64_t colour = 0, std::int64_t normal = 0,
          float reflectance = 0) {
  look_t look{};
  look.name = "worn", look.shader = shader, look.colour_map = colour, look.normal_map = normal,
  look.reflectance = reflectance;
  scene.visuals[0].look = static_cast<int>(scene.looks.size());
  scene.looks.push_back(look);
}

// Draws the scene and compares pixels all over its first shape with `colour` (linear) at the point that the eye's
// ray hits.
void compare(const scene_t& scene, const visual::LookFiles& files, double tolerance,
             const std::function<Vector3d(const Hit&, const Vector3d& eye)>& colour,
             const visual::Settings& settings = {}) {
  display();
  const visual::SceneView view(scene, {}, settings, {}, files);
  visual::Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  CHECK(renderer.take_warnings().empty());
  std::vector<Eigen::Isometry3d> poses;
  for (const body_def_t& b : scene.bodies) poses.push_back(to_eigen(b.pose));
  const visual::DrawList list = view.draw(poses, {});
  const Image image = draw(renderer, list);
  const auto& batches = list.translucent.empty() ? list.opaque : list.translucent;
  const PlacedTriangles triangles(view.geometries()[static_cast<std::size_t>(batches[0].geometry)],
                                  list.instances[static_cast<std::size_t>(batches[0].first)]);
  const Vector3d eye = to_eigen(scene.camera.position_m);
  const auto hit = [&](double x, double y) { return meet(triangles, eye, ray(scene, x, y)); };
  int held = 0;
  for (int y = 10; y < kHeight; y += 14)
    for (int x = 10; x < kWidth; x += 14) {
      const auto here = hit(x, y);
      // Excludes pixels shared by another surface, and grazing angles, where a pixel covers many places.
      if (!here || !hit(x - 1, y) || !hit(x + 1, y) || !hit(x, y - 1) || !hit(x, y + 1)) continue;
      if (std::abs(here->point.normal.dot(ray(scene, x, y))) < 0.35) continue;
      const Vector3d expected = settings.exposure * colour(*here, eye), seen = image.at(x, y);
      for (int c = 0; c < 3; ++c) {
        INFO("pixel " << x << ", " << y << ", channel " << c);
        REQUIRE(seen[c] == Approx(srgb(expected[c])).margin(tolerance));
      }
      ++held;
    }
  CHECK(held > 100);
}

// Smooth and small: texels are larger than pixels, and neighbours differ so little that the eight-bit weights of a
// sampler err by less than half a level.
Raster smooth_picture() {
  Raster r{16, 16, false, {}};
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i)
      for (const double c :
           {150 + 60 * std::sin(2 * std::numbers::pi * i / 16), 140 + 50 * std::cos(2 * std::numbers::pi * j / 16),
            130 + 50 * std::sin(2 * std::numbers::pi * (i + 2 * j) / 16), 255.0})
        r.rgba.push_back(static_cast<std::uint8_t>(std::lround(c)));
  return r;
}

// Dents and bumps, different along u and v, so that a swap or a sign error of either is detected.
Raster bumps() {
  Raster r{16, 16, false, {}};
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) {
      const Vector3d n = Vector3d(0.5 * std::sin(2 * std::numbers::pi * i / 16),
                                  0.2 + 0.3 * std::cos(2 * std::numbers::pi * j / 16), 1)
                             .normalized();
      for (int c = 0; c < 3; ++c) r.rgba.push_back(static_cast<std::uint8_t>(std::lround((n[c] + 1) * 127.5)));
      r.rgba.push_back(255);
    }
  return r;
}

double as_direction(double byte) { return byte / 127.5 - 1; }

}  // namespace

TEST_CASE("Each kind of lamp shades each kind of surface by Phong's formula") {
  const int lamp = GENERATE(light_def_t::POINT, light_def_t::DIRECTIONAL, light_def_t::SPOT);
  const int shape = GENERATE(shape_def_t::SPHERE, shape_def_t::BOX, shape_def_t::PLANE, shape_def_t::CYLINDER);
  const scene_t scene = lit(shape, lamp);
  compare(scene, {}, kTolerance,
          [&](const Hit& hit, const Vector3d& eye) { return phong(scene, scene.visuals[0], hit.point, eye); });
}

TEST_CASE("Lamps are added, and exposure scales all light before encoding") {
  scene_t scene = lit(shape_def_t::SPHERE, light_def_t::POINT);
  scene.lights.clear();
  for (int i = 0; i < 8; ++i) {
    scene.lights.push_back(lamp_of(i % 3));
    scene.lights.back().intensity = 0.1f;
    scene.lights.back().pose.position_m.y = -1.5 + 0.4 * i;
  }
  visual::Settings settings;
  settings.exposure = GENERATE(0.5, 1.0, 2.0);
  compare(
      scene, {}, kTolerance,
      [&](const Hit& hit, const Vector3d& eye) { return phong(scene, scene.visuals[0], hit.point, eye); },
      settings);
}

TEST_CASE("Gouraud shades the corners of the triangles and interpolates between them") {
  const int lamp = GENERATE(light_def_t::POINT, light_def_t::DIRECTIONAL, light_def_t::SPOT);
  scene_t scene = lit(shape_def_t::SPHERE, lamp);
  set_look(scene, "gouraud");
  const visual_def_t& v = scene.visuals[0];
  compare(scene, {}, kTolerance, [&](const Hit& hit, const Vector3d& eye) { return gouraud(scene, v, hit, eye); });
  // Phong shading does not match here; otherwise the test above could not distinguish them.
  double largest = 0;
  visual::Instance at_two;
  at_two.position << 2, 0, 0, 1;
  const PlacedTriangles ball(visual::unit_sphere(12), at_two);
  for (double y = -0.4; y < 0.4; y += 0.01)
    if (const auto hit = meet(ball, Vector3d::Zero(), Vector3d(1, y, 0.1).normalized()))
      largest = std::max(
          largest, (gouraud(scene, v, *hit, Vector3d::Zero()) - phong(scene, v, hit->point, Vector3d::Zero()))
                       .cwiseAbs()
                       .maxCoeff());
  if (lamp != light_def_t::SPOT) CHECK(largest > 0.02);
}

TEST_CASE("A colour map scales reflected light but neither highlights nor emitted light") {
  const int shape = GENERATE(shape_def_t::SPHERE, shape_def_t::BOX, shape_def_t::PLANE);
  scene_t scene = lit(shape, light_def_t::POINT);
  set_look(scene, "textured", 7);
  const Raster picture = smooth_picture();
  compare(scene, {{{7, picture}}, {}}, kTolerance + 0.5, [&](const Hit& hit, const Vector3d& eye) {
    return phong(scene, scene.visuals[0], hit.point, eye, bilinear(picture, hit.point.uv, linear));
  });
}

TEST_CASE("A normal map rotates normals along tangent and binormal") {
  const int shape = GENERATE(shape_def_t::SPHERE, shape_def_t::BOX, shape_def_t::PLANE, shape_def_t::CYLINDER);
  scene_t scene = lit(shape, light_def_t::POINT);
  set_look(scene, "normal_mapped", 0, 8);
  const Raster map = bumps();
  // A weight of eight bits errs by 1/512 of the difference of two texels, at most 0.2: 0.0004 of a direction, a
  // tenth of a level.
  compare(scene, {{{8, map}}, {}}, kTolerance + 0.5, [&](const Hit& hit, const Vector3d& eye) {
    Point bumpy = hit.point;
    bumpy.normal = mapped_normal(hit.point, bilinear(map, hit.point.uv, as_direction));
    return phong(scene, scene.visuals[0], bumpy, eye);
  });
}

namespace {
// Smooth in all directions and different in each; in eight bits.
Vector3d around_at(const Vector3d& d) {
  return Vector3d(128, 128, 128) + Vector3d(100 * d.x(), 90 * d.y(), 80 * d.z());
}

Vector3d decoded(const Vector3d& bytes) { return bytes.unaryExpr(&linear); }

Raster around() {
  Raster r{256, 128, false, {}};
  for (int j = 0; j < r.height; ++j)
    for (int i = 0; i < r.width; ++i) {
      // scene_t.lcm: the middle lies along +x, +y a quarter from the left, the top along +z.
      const double azimuth = std::numbers::pi * (1 - 2 * (i + 0.5) / r.width),
                   up = std::numbers::pi * ((j + 0.5) / r.height - 0.5);
      const Vector3d c =
          around_at({std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up)});
      for (int k = 0; k < 3; ++k) r.rgba.push_back(static_cast<std::uint8_t>(std::lround(c[k])));
      r.rgba.push_back(255);
    }
  return r;
}

Vector3d mirrored(const Point& p, const Vector3d& eye) {
  const Vector3d in = (p.at - eye).normalized(), out = in - 2 * in.dot(p.normal) * p.normal;
  return decoded(around_at(out));
}
// The picture is rounded twice to eight bits, half a level each time, before display.
constexpr double kRounded = 1;
}  // namespace

TEST_CASE(
    "A mirror shows the environment in the reflected direction, with Schlick's factor") {
  const int shape = GENERATE(shape_def_t::SPHERE, shape_def_t::BOX, shape_def_t::PLANE);
  const float reflectance = GENERATE(0.04f, 0.5f, 1.0f);
  scene_t scene = lit(shape, light_def_t::POINT);
  scene.environment_asset = 9;
  scene.visuals[0].alpha = GENERATE(1.0f, 0.4f);
  set_look(scene, "reflecting", 0, 0, reflectance);
  compare(scene, {{{9, around()}}, {}}, kTolerance + kRounded,
          [&](const Hit& hit, const Vector3d& eye) -> Vector3d {
            const double f = fresnel(reflectance, hit.point.normal.dot((eye - hit.point.at).normalized()));
            const double a = scene.visuals[0].alpha;
            const Vector3d behind = decoded(around_at(hit.point.at.normalized()));  // the eye is at the origin
            const Vector3d through = a * phong(scene, scene.visuals[0], hit.point, eye) + (1 - a) * behind;
            return (1 - f) * through + f * mirrored(hit.point, eye);
          });
}

TEST_CASE("A normal map also changes the reflection of a mirror") {
  scene_t scene = lit(shape_def_t::PLANE, light_def_t::POINT);
  scene.environment_asset = 9;
  set_look(scene, "reflecting", 0, 8, 0.6f);
  const Raster map = bumps();
  compare(scene, {{{8, map}, {9, around()}}, {}}, kTolerance + kRounded,
          [&](const Hit& hit, const Vector3d& eye) -> Vector3d {
            Point bumpy = hit.point;
            bumpy.normal = mapped_normal(hit.point, bilinear(map, hit.point.uv, as_direction));
            const double f = fresnel(double{0.6f}, bumpy.normal.dot((eye - bumpy.at).normalized()));
            return (1 - f) * phong(scene, scene.visuals[0], bumpy, eye) + f * mirrored(bumpy, eye);
          });
}

TEST_CASE("Without an environment picture a mirror shows the background colour") {
  scene_t scene = lit(shape_def_t::SPHERE, light_def_t::DIRECTIONAL);
  scene.background = to_vec3f({0.3, 0.1, 0.5});
  set_look(scene, "reflecting", 0, 0, 0.3f);
  compare(scene, {}, kTolerance, [&](const Hit& hit, const Vector3d& eye) -> Vector3d {
    const double f = fresnel(double{0.3f}, hit.point.normal.dot((eye - hit.point.at).normalized()));
    return (1 - f) * phong(scene, scene.visuals[0], hit.point, eye) + f * Vector3d(0.3, 0.1, 0.5);
  });
}

TEST_CASE("A translucent surface transmits the light that it does not reflect, in linear light") {
  const float alpha = GENERATE(0.1f, 0.5f, 0.9f);
  const float reflectance = GENERATE(0.0f, 0.04f);
  scene_t scene = lit(shape_def_t::SPHERE, light_def_t::POINT);
  scene.lights[0].intensity = GENERATE(0.8f, 4.0f);  // brighter than white, if it were opaque
  scene.background = to_vec3f({0.2, 0.5, 0.3});
  scene.visuals[0].alpha = alpha;
  set_look(scene, reflectance > 0 ? "reflecting" : "phong", 0, 0, reflectance);
  compare(scene, {}, kTolerance, [&](const Hit& hit, const Vector3d& eye) -> Vector3d {
    const double f =
        reflectance > 0 ? fresnel(reflectance, hit.point.normal.dot((eye - hit.point.at).normalized())) : 0;
    const Vector3d behind(0.2, 0.5, 0.3);
    const Vector3d through = alpha * phong(scene, scene.visuals[0], hit.point, eye) + (1 - alpha) * behind;
    return (1 - f) * through + f * behind;  // the background is the environment
  });
}

TEST_CASE("The environment is visible behind all surfaces, in its direction") {
  scene_t scene = lit(shape_def_t::SPHERE, light_def_t::POINT);
  scene.environment_asset = 9;
  scene.camera =
      to_pose(Eigen::Isometry3d(Eigen::AngleAxisd(GENERATE(0.0, 2.0, 4.0), Vector3d(0.3, -0.2, 1).normalized())));
  scene.visuals.clear();
  visual::Settings settings;
  settings.exposure = GENERATE(0.7, 1.0);
  display();
  const visual::SceneView view(scene, {}, settings, {}, {{{9, around()}}, {}});
  visual::Renderer renderer(kWidth, kHeight, settings.shadow_size);
  renderer.load(view.geometries(), view.lighting(), view.reliefs(), view.appearance());
  const Image image = draw(renderer, view.draw({}, {}));
  for (int y = 5; y < kHeight; y += 30)
    for (int x = 5; x < kWidth; x += 30) {
      const Vector3d expected = settings.exposure * decoded(around_at(ray(scene, x, y)));
      for (int c = 0; c < 3; ++c)
        REQUIRE(image.at(x, y)[c] == Approx(srgb(expected[c])).margin(kTolerance + kRounded));
    }
}
