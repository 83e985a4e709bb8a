// Compares the normals of the drawn picture with those of lcmtypes/relief.h, which all other modalities use. The
// surface shader is drawn unchanged, with one lamp that outputs the normal instead of light.
#include <epoxy/gl.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <random>
#include <tactus/material_def_t.hpp>

#include "lcmtypes/relief.h"
#include "sync/pictures/confined_pictures.h"
#include "tests/source_dir.h"
#include "tests/visual_node/support/offscreen.h"
#include "visual_node/gl/buffers.h"
#include "visual_node/gl/program.h"
#include "visual_node/gl/shader_library.h"

using namespace tactus;
using namespace tactus::visual;
using Eigen::Vector3d;

namespace {

// One quad that covers the picture, on a plane of the body frame.
constexpr const char* kQuad = R"(#version 330 core
uniform vec3 corner, along_x, along_y, outward, turn;
out vec3 at;
out vec3 facing;
out vec4 shadow_at;
flat out vec4 paint;
flat out vec4 polish;
flat out vec3 returned;
flat out vec3 glow;
out vec3 at_body;
out vec3 facing_body;
flat out mat3 body_axes;
vec3 turned(vec3 v) {
  float angle = length(turn);
  vec3 axis = angle > 0.0 ? turn / angle : vec3(0.0, 0.0, 1.0);
  return v * cos(angle) + cross(axis, v) * sin(angle) + axis * dot(axis, v) * (1.0 - cos(angle));
}
void main() {
  vec2 c = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at_body = corner + c.x * along_x + c.y * along_y;
  facing_body = outward;
  for (int i = 0; i < 3; ++i) body_axes[i] = turned(mat3(1.0)[i]);
  at = body_axes * at_body;
  facing = body_axes * facing_body;
  shadow_at = vec4(0.0);
  paint = vec4(1.0);
  polish = vec4(0.0, 0.0, 0.0, 1.0);
  returned = glow = vec3(0.0);
  gl_Position = vec4(2.0 * c - 1.0, 0.0, 1.0);
}
)";
constexpr const char* kDefines =
    "#define LIGHTS 1\n#define LAMPS sum = n;\n#define SHADOWS 0\n#define RELIEF 1\n#define MAPPED 0\n#define "
    "COLOUR_MAP 0\n"
    "#define NORMAL_MAP 0\n#define MIRROR 0\n#define GOURAUD 0\n#define LAMP_DIFFUSE vec4[](vec4(0))\n"
    "#define LAMP_SPECULAR vec4[](vec4(0))\n#define LAMP_ATTENUATION vec4[](vec4(0))\n#define LAMP_CONE "
    "vec4[](vec4(0))\n";

// A picture of floats.
class FloatTarget {
 public:
  FloatTarget(int width, int height) : width_(width), height_(height) {
    glGenFramebuffers(1, &framebuffer_);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    REQUIRE(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE);
    glViewport(0, 0, width, height);
  }
  ~FloatTarget() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteTextures(1, &texture_);
  }
  std::vector<Eigen::Vector4f> read() const {
    std::vector<Eigen::Vector4f> out(static_cast<std::size_t>(width_ * height_));
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, out.data());
    return out;
  }

 private:
  int width_, height_;
  unsigned framebuffer_ = 0, texture_ = 0;
};

struct Angles {
  double mean_deg = 0, max_deg = 0, steepest_deg = 0;
};

// Angle between the two normals at every point of a grid finer than the map, over all of it.
Angles compare(const Program& program, const Relief& relief, const Vector3d& normal_body, const Vector3d& turn) {
  constexpr int kPerPixel = 3;  // two of three points lie off the pixel centres
  const int width = kPerPixel * relief.columns, height = kPerPixel * relief.rows;
  const BumpAxes axes = bump_axes(normal_body);
  // Offset from the corner of the map, so that the seam lies within.
  Vector3d corner = Vector3d::Zero(), x = Vector3d::Zero(), y = Vector3d::Zero();
  corner[axes.across] = 0.07;
  corner[axes.u] = -0.3 * static_cast<double>(relief.size_m.x()),
  corner[axes.v] = 1.4 * static_cast<double>(relief.size_m.y());
  x[axes.u] = static_cast<double>(relief.size_m.x()), y[axes.v] = static_cast<double>(relief.size_m.y());

  const FloatTarget target(width, height);
  const ReliefTexture texture(relief);
  program.use();
  for (const auto& [name, value] :
       {std::pair{"corner", corner}, {"along_x", x}, {"along_y", y}, {"outward", normal_body}, {"turn", turn}})
    program.set(name, Eigen::Vector3f(value.cast<float>()));
  program.set("relief_size", texture.size_m());
  program.set("exposure", 1.0f);
  program.set("eye", Eigen::Vector3f(0, 0, 9));
  program.set("slope_map", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture.id());
  unsigned vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  for (const auto off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) glDisable(off);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDeleteVertexArrays(1, &vertices);
  const std::vector<Eigen::Vector4f> drawn = target.read();

  const double angle = turn.norm();
  const Eigen::Matrix3d body = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                         : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  Angles found;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const Vector3d place = corner + x * ((column + 0.5) / width) + y * ((row + 0.5) / height);
      const Vector3d mine = body * relief_normal(normal_body, relief.slope(bump_at(relief.size_m, axes, place)));
      const Vector3d gpu = drawn[static_cast<std::size_t>(row * width + column)].head<3>().cast<double>();
      const double apart_deg = 180 / M_PI * std::atan2(mine.cross(gpu).norm(), mine.dot(gpu));
      found.max_deg = std::max(found.max_deg, apart_deg);
      found.mean_deg += apart_deg / (width * height);
      found.steepest_deg = std::max(found.steepest_deg,
                                    180 / M_PI * std::acos(std::clamp(mine.dot(body * normal_body), -1.0, 1.0)));
    }
  return found;
}

HeightMap planks() {
  std::ifstream file(source_dir() + "/sim_node/scenes/planks.png", std::ios::binary);
  const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(file), {});
  return sync::ConfinedPictures().height_map(bytes);
}

// As rough as a map can be: neighbouring pixels are independent.
HeightMap noise() {
  std::mt19937 random(5);
  HeightMap map{47, 33, 65535, {}};
  for (int i = 0; i < 47 * 33; ++i) map.levels.push_back(static_cast<std::uint16_t>(random() % 65536));
  return map;
}

}  // namespace

TEST_CASE("The normals of the haptic and the drawn surface agree within 1 degree over the whole map") {
  test::display();
  const ShaderLibrary library;
  const Program program({{"quad.vert", kQuad}},
                        {library.source_file("surface.glsl"), library.source_file("lamps.glsl"), library.source_file("shade.glsl"),
                         library.source_file("phong.frag"), library.source_file("surface_end.frag")},
                        kDefines);
  struct Case {
    std::string name;
    HeightMap map;
    double size_m, height_m;
  };
  const Vector3d outward[] = {{0, 0, 1}, {-1, 0, 0}, {0.2, 0.9, 0.1}, {-0.3, 0.2, -0.6}};
  const Vector3d turn[] = {{0, 0, 0}, {0.4, -1.1, 0.7}, {0, 0, 2}, {-0.2, 0.3, 0.1}};
  for (const Case& c : {Case{"planks, 3 mm", planks(), 0.08, 0.003}, Case{"noise, gentle", noise(), 0.05, 0.0005},
                        Case{"noise, as steep as walls", noise(), 0.05, 0.02}}) {
    const Relief relief = make_relief(c.map, test::rough(1, c.size_m, 0.7 * c.size_m, c.height_m));
    for (std::size_t i = 0; i < std::size(outward); ++i) {
      const Angles a = compare(program, relief, outward[i].normalized(), turn[i]);
      CAPTURE(c.name, i, a.mean_deg, a.max_deg, a.steepest_deg);
      CHECK(a.max_deg <= 1);
      CHECK(a.steepest_deg > 5);  // there is a relief
    }
  }
}
