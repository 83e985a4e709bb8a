#include "sim_node/scene/extensions/tactus_looks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tactus/asset_ref_t.hpp>
#include <tactus/look_t.hpp>
#include <tactus/pass_t.hpp>
#include <tactus/shader_t.hpp>
#include <tactus/uniform_t.hpp>

#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/materials/pictures.h"
#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/sandbox/regular_file.h"
#include "sync/text/settings.h"

namespace tactus::sim {
namespace {

// Built-in shaders of visual_node (visual_node/README.md): for surfaces, and for passes.
const std::vector<std::string> kSurfaceShaders{"gouraud", "phong", "normal_mapped", "reflecting", "textured"};
const std::vector<std::string> kPassShaders{"greyscale", "blur", "edges"};

// Design: a shader of a thousand lines; more uniforms than usual shaders have; the number of passes that 60 Hz
// allows.
constexpr std::uintmax_t kMaxShaderBytes = 64 << 10;
constexpr std::size_t kMaxUniforms = 32, kMaxShaders = 64, kMaxPasses = 16;
constexpr std::size_t kMaxName = 64;  // as in uniform_t.lcm
constexpr float kMaxUniformMagnitude = 1e6f;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_identifier(const std::string& name) {
  const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '_'; };
  return !name.empty() && name.size() <= kMaxName && letter(static_cast<unsigned char>(name[0])) &&
         !name.starts_with("gl_") &&
         std::all_of(name.begin(), name.end(), [&](unsigned char c) { return letter(c) || std::isdigit(c); });
}

void check_shader(const LoadContext& context, const sdf::Element& element, const std::string& name,
                  const std::vector<std::string>& known) {
  const auto& own = context.world.shaders;
  if (!is_identifier(name))
    context.reject(element,
                   "names shader \"" + name + "\": it must be letters, digits and _, 64 at most, no digit first");
  if (contains(known, name) ||
      std::any_of(own.begin(), own.end(), [&](const shader_t& s) { return s.name == name; }))
    return;
  std::string names;
  for (const std::string& each : known) names += (names.empty() ? "" : ", ") + each;
  for (const shader_t& each : own) names += ", " + each.name;
  context.warn(element, "names shader \"" + name +
                            "\", which is neither the scene's nor visual_node's: there are " + names +
                            "; another renderer may have it");
}

// "scale 2; tint 1 0.5 0"
std::vector<uniform_t> read_uniforms(const LoadContext& context, const sdf::Element& element,
                                     const std::string& text) {
  std::vector<uniform_t> uniforms;
  std::istringstream all(text);
  for (std::string part; std::getline(all, part, ';');) {
    std::istringstream words(part);
    uniform_t uniform{};
    if (!(words >> uniform.name)) continue;
    const auto reject = [&](const std::string& what) {
      context.reject(element,
                     "has uniforms=\"" + text + "\": " + what + "; write it as \"scale 2; tint 1 0.5 0\"");
    };
    if (!is_identifier(uniform.name)) reject("\"" + uniform.name + "\" is not a valid uniform name");
    for (std::string word; words >> word; ++uniform.count) {
      if (uniform.count == 4) reject(uniform.name + " has more than 4 numbers");
      try {
        uniform.values[uniform.count] = static_cast<float>(sync::parse_quantity(word, ""));
      } catch (const std::invalid_argument& e) {
        reject(uniform.name + ": " + e.what());
      }
      if (!(std::abs(uniform.values[uniform.count]) <= kMaxUniformMagnitude))
        reject(uniform.name + " exceeds 1e6");
    }
    if (uniform.count == 0) reject(uniform.name + " has no number");
    for (const uniform_t& other : uniforms)
      if (other.name == uniform.name) reject(uniform.name + " is given twice");
    if (uniforms.size() == kMaxUniforms) reject("more than " + std::to_string(kMaxUniforms) + " are given");
    uniforms.push_back(uniform);
  }
  return uniforms;
}

// Reads all attributes except the name.
LookAttributes read_look_attributes(LoadContext& context, const sdf::Element& element, Attributes& attributes) {
  LookAttributes look;
  look.shader = attributes.text("shader");
  if (look.shader && !look.shader->empty()) check_shader(context, element, *look.shader, kSurfaceShaders);
  const auto picture = [&](const char* what, PictureUse use) -> std::optional<std::int64_t> {
    const auto uri = attributes.text(what);
    if (!uri) return std::nullopt;
    return uri->empty() ? 0 : picture_of(context, element, what, *uri, use);
  };
  look.colour_map = picture("colour_map", PictureUse::kColour);
  look.normal_map = picture("normal_map", PictureUse::kDirections);
  look.reflectance = attributes.quantity("reflectance", "1", 0, 1);
  if (const auto uniforms = attributes.text("uniforms"))
    look.uniforms = read_uniforms(context, element, *uniforms);
  return look;
}

const LookAttributes& find_look(const LoadContext& context, const sdf::Element& element, const std::string& name) {
  const auto known = context.look_of.find(name);
  if (known != context.look_of.end()) return *known->second;
  std::string names;
  for (const auto& [each, look] : context.look_of) names += (names.empty() ? "" : ", ") + each;
  context.reject(
      element, "names look \"" + name + "\": there " + (names.empty() ? "is none in this scene" : "are " + names));
}

void read_look(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const std::string name = attributes.required_text("name");
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (name.size() > kMaxName || !std::all_of(name.begin(), name.end(), printable))
    context.reject(element, "has a name that is longer than 64 characters or not printable ASCII");
  const auto base = attributes.text("base");
  auto look = std::make_shared<LookAttributes>(read_look_attributes(context, element, attributes));
  attributes.done();
  if (base) look->add(find_look(context, element, *base));
  look->name = name;
  if (!context.look_of.emplace(name, look).second)
    context.reject(element, "has a name that another look has: choose another");
}

std::int64_t read_text(LoadContext& context, const sdf::Element& element, const std::string& what,
                       const std::string& uri) {
  const std::filesystem::path file = context.asset_file(uri, element);
  try {
    sync::Asset text{asset_ref_t::SHADER, file.filename().string(), sync::read_regular_file(file, kMaxShaderBytes)};
    if (text.bytes.empty()) throw std::runtime_error("it is empty");
    int line = 1;
    for (const std::uint8_t c : text.bytes) {
      // The characters of GLSL 3.30, 3.1, and printable ASCII for comments.
      if ((c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c > 0x7e)
        throw std::runtime_error("line " + std::to_string(line) + " holds a character that is not printable ASCII");
      line += c == '\n';
    }
    const std::int64_t hash = sync::fnv1a_64(text.bytes.data(), text.bytes.size());
    auto& texts = context.world.shader_texts;
    if (std::none_of(texts.begin(), texts.end(),
                     [&](const sync::Asset& other) { return other.bytes == text.bytes; }))
      texts.push_back(std::move(text));
    return hash;
  } catch (const std::exception& e) {
    context.reject(element, "names " + what + " \"" + uri + "\", which cannot be read: " + e.what());
  }
}

void read_shader(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  shader_t shader{};
  shader.name = attributes.required_text("name");
  shader.fragment_file = attributes.required_text("fragment");
  shader.vertex_file = attributes.text("vertex").value_or("");
  attributes.done();
  if (!is_identifier(shader.name))
    context.reject(
        element, "has name=\"" + shader.name + "\": it must be letters, digits and _, 64 at most, no digit first");
  if (contains(kSurfaceShaders, shader.name) || contains(kPassShaders, shader.name))
    context.reject(element, "has a name that a shader of visual_node has: choose another");
  for (const shader_t& other : context.world.shaders)
    if (other.name == shader.name) context.reject(element, "has a name that another shader has: choose another");
  if (context.world.shaders.size() == kMaxShaders)
    context.reject(element, "is one too many: a scene may have " + std::to_string(kMaxShaders));
  shader.fragment_asset = read_text(context, element, "fragment", shader.fragment_file);
  if (!shader.vertex_file.empty()) shader.vertex_asset = read_text(context, element, "vertex", shader.vertex_file);
  context.world.shaders.push_back(shader);
}

void read_pass(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  pass_t pass{};
  pass.shader = attributes.required_text("shader");
  pass.uniforms = read_uniforms(context, element, attributes.text("uniforms").value_or(""));
  pass.uniform_count = static_cast<std::int32_t>(pass.uniforms.size());
  attributes.done();
  check_shader(context, element, pass.shader, kPassShaders);
  if (context.world.passes.size() == kMaxPasses)
    context.reject(element, "is one too many: a scene may have " + std::to_string(kMaxPasses));
  context.world.passes.push_back(pass);
}

void read_environment(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const std::string uri = attributes.required_text("picture");
  attributes.done();
  if (context.world.environment_asset != 0) context.reject(element, "appears twice: a scene has one environment");
  context.world.environment_asset = picture_of(context, element, "picture", uri, PictureUse::kColour);
}

}  // namespace

void LookAttributes::add(const LookAttributes& others) {
  if (name.empty()) name = others.name;
  if (!shader) shader = others.shader;
  if (!colour_map) colour_map = others.colour_map;
  if (!normal_map) normal_map = others.normal_map;
  if (!reflectance) reflectance = others.reflectance;
  if (!uniforms) uniforms = others.uniforms;
}

void read_looks(LoadContext& context, const sdf::Element& world) {
  const auto each = [&](const char* name, void (*read)(LoadContext&, const sdf::Element&)) {
    for (const sdf::Element& element : world.children(name)) read(context, element);
  };
  each("tactus:shader", read_shader);  // before the elements that name shaders
  each("tactus:look", read_look);
  each("tactus:pass", read_pass);
  each("tactus:environment", read_environment);
}

LookAttributes read_visual_look(LoadContext& context, const sdf::Element& element) {
  Attributes attributes(context, element);
  const auto name = attributes.text("name");
  LookAttributes look = read_look_attributes(context, element, attributes);
  attributes.done();
  if (name) look.add(find_look(context, element, *name));
  return look;
}

int look_index(LoadContext& context, const LookAttributes& attributes) {
  if (attributes.empty()) return -1;
  look_t look{};
  look.colour_map = attributes.colour_map.value_or(0), look.normal_map = attributes.normal_map.value_or(0);
  look.reflectance = static_cast<float>(attributes.reflectance.value_or(0));
  look.uniforms = attributes.uniforms.value_or(std::vector<uniform_t>{});
  look.uniform_count = static_cast<std::int32_t>(look.uniforms.size());
  // Without a shader name, use the one that shows all given attributes.
  look.shader = attributes.shader.value_or(look.reflectance > 0 ? "reflecting"
                                           : look.normal_map    ? "normal_mapped"
                                           : look.colour_map    ? "textured"
                                                                : "");
  if (look.shader.empty() && !look.colour_map && !look.normal_map && look.reflectance == 0 &&
      look.uniforms.empty())
    return -1;
  const auto bytes = sync::encode(look);
  auto& looks = context.world.looks;
  const auto [at, is_new] =
      context.look_index_of.try_emplace(std::string(bytes.begin(), bytes.end()), static_cast<int>(looks.size()));
  if (!is_new) return at->second;
  look.name = attributes.name.empty() ? "look " + std::to_string(looks.size()) : attributes.name;
  looks.push_back(look);
  return at->second;
}

}  // namespace tactus::sim
