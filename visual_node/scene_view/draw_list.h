// The content of one frame as plain data: the scene view builds it and the renderer draws it. All places are in the axes of the world
// about the origin of the picture, camera.origin_m.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "visual_node/lens/camera.h"
#include "visual_node/lens/stereo.h"

namespace tactus::visual {

// One shape and its pose. The layout is that of the instance attributes of shaders/surface.vert.
struct Instance {
  Eigen::Vector4f orientation{0, 0, 0, 1};  // T_world_shape, quaternion x, y, z, w
  Eigen::Vector4f position{0, 0, 0, 1};     // m, about the origin; w unused
  Eigen::Vector4f scale{1, 1, 1, 16};       // along the axes of the shape; w: Phong exponent
  Eigen::Vector4f diffuse{1, 1, 1, 1};      // linear; w: opacity
  Eigen::Vector4f specular{0, 0, 0, 0};     // linear; w unused
  Eigen::Vector4f ambient{0, 0, 0, 0};      // share of the ambient light that the shape returns; w unused
  Eigen::Vector4f emissive{0, 0, 0, 0};     // linear; w unused
  // T_world_body, as above: a relief is defined in the frame of the body. The position of a far body may be moved by whole repetitions of
  // its relief.
  Eigen::Vector4f body_orientation{0, 0, 0, 1};
  Eigen::Vector4f body_position{0, 0, 0, 1};
};
static_assert(sizeof(Instance) == 9 * 16);

// Consecutive instances of one geometry.
struct Batch {
  int geometry = 0;
  int first = 0;
  int count = 0;
  bool casts_shadow = true;
  int relief = -1;  // -1: smooth
  int look = 0;     // index in Appearance::looks
};

// The layout is that of one element of the light block in shaders/lamps.glsl (std140).
struct Light {
  Eigen::Vector4f position{0, 0, 0, 0};  // m, about the origin; w: 0 for a directional light, which has no position
  Eigen::Vector4f direction{0, 0, -1, 0};   // unit, away from the lamp; w unused
  Eigen::Vector4f diffuse{0, 0, 0, 0};      // linear, times intensity; w: range in m
  Eigen::Vector4f specular{0, 0, 0, 0};     // linear, times intensity; w unused
  Eigen::Vector4f attenuation{1, 0, 0, 0};  // constant, linear 1/m, quadratic 1/m^2
  // Cone: factor and offset on the cosine of the angle to the axis, 0 outside and 1 inside, and the exponent of
  // its falloff. Factor 0: no cone.
  Eigen::Vector4f cone{0, 1, 1, 0};
};
static_assert(sizeof(Light) == 6 * 16);
inline constexpr int kMaxLights = 8;

struct Lighting {
  std::vector<Light> lights;                                  // at most kMaxLights
  int shadow_light = -1;                                      // index of the light that casts a shadow, -1: none
  Eigen::Matrix4f shadow_clip = Eigen::Matrix4f::Identity();  // places about the origin to the clip space of that lamp
  Eigen::Vector3f ambient = Eigen::Vector3f::Zero();          // linear
  Eigen::Vector3f background = Eigen::Vector3f::Zero();       // linear
  float exposure = 1;
};

// A disc of light, drawn over the picture and added to it.
struct Glow {
  Eigen::Vector4f centre;  // m, about the origin; w: growth of the flash, 0 .. 1
  Eigen::Vector4f u, v;    // half axes, m, world
  Eigen::Vector4f colour;  // linear, premultiplied; w unused
};
static_assert(sizeof(Glow) == 4 * 16);

// A straight line in space, drawn over the picture, in sRGB.
struct Stroke {
  Eigen::Vector4f from;    // m, about the origin; w: width in pixels
  Eigen::Vector4f to;      // m, about the origin; w unused
  Eigen::Vector4f colour;  // w: opacity
};
static_assert(sizeof(Stroke) == 3 * 16);

// A filled rectangle in pixels from the top left, drawn over the picture, in sRGB.
struct Rect {
  float x = 0, y = 0, width = 0, height = 0;
  float red = 0, green = 0, blue = 0, alpha = 1;
};

// A picture of text without colour.
struct TextPicture {
  int width = 0, height = 0;           // pixels
  std::vector<std::uint8_t> coverage;  // 0 .. 255 a pixel, the highest row first
};

// Some rows of a text picture over the picture, pixel by pixel, in sRGB.
struct Label {
  std::shared_ptr<const TextPicture> text;
  int first_row = 0, rows = 0;  // of the text picture
  float x = 0, y = 0;           // whole pixels from the top left
  float red = 1, green = 1, blue = 1;
};

struct DrawList {
  Camera camera;            // of the head; used for depth order and the size of flashes
  std::vector<View> views;  // views to draw; empty: the camera's view in the whole picture
  Lighting lighting;
  std::vector<Instance> instances;
  std::vector<Batch> opaque;       // roughly front to back
  std::vector<Batch> translucent;  // back to front
  std::vector<Glow> glows;
  std::vector<Stroke> strokes;
  std::vector<Rect> overlay;
  std::vector<Label> labels;  // drawn over the overlay
};

}  // namespace tactus::visual
