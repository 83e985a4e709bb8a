#include "tests/sdformat/random_world.h"

#include <cmath>
#include <sstream>

namespace tactus::test {
namespace {

std::string version_text(int version) { return "1." + std::to_string(version); }

std::string file_of(int version, const std::string& inside) {
  return "<sdf version=\"" + version_text(version) + "\">\n" + inside + "</sdf>\n";
}

}  // namespace

RandomWorld::RandomWorld(std::uint64_t seed) : random_(seed) { files_["scene.sdf"] = world(); }

double RandomWorld::number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

std::string RandomWorld::numbers(int count, double low, double high) {
  std::ostringstream text;
  text.precision(random_() % 2 ? 17 : 4);
  for (int i = 0; i < count; ++i) text << (i ? " " : "") << number(low, high);
  return text.str();
}

std::string RandomWorld::frame_attribute(const Scope& scope) {
  if (scope.version == 4 || scope.frames.empty() || chance(0.5)) return "";
  return std::string(scope.version <= 6 ? " frame=\"" : " relative_to=\"") + scope.frames[static_cast<std::size_t>(below(scope.frames.size()))] + "\"";
}

std::string RandomWorld::pose(const Scope* scope) {
  if (chance(0.2)) return "";
  const int version = scope ? scope->version : 9;
  std::string attributes = scope ? frame_attribute(*scope) : "";
  std::string rotation = numbers(3, -3, 3);
  if (version >= 9 && chance(0.3)) {
    attributes += " degrees=\"true\"";
    rotation = numbers(3, -180, 180);
  } else if (version >= 9 && chance(0.3)) {
    attributes += " rotation_format=\"quat_xyzw\"";
    double q[4], norm = 0;
    for (double& each : q) norm += std::pow(each = number(-1, 1), 2);
    std::ostringstream text;
    text.precision(17);
    for (const double each : q) text << each / std::sqrt(norm) << " ";
    rotation = text.str();
  }
  return "<pose" + attributes + ">" + numbers(3, -2, 2) + " " + rotation + "</pose>\n";
}

std::string RandomWorld::geometry() {
  const std::string radius = "<radius>" + numbers(1, 0.1, 1) + "</radius>", length = "<length>" + numbers(1, 0.1, 1) + "</length>";
  switch (below(5)) {
    case 0: return "<geometry><box><size>" + numbers(3, 0.1, 1) + "</size></box></geometry>\n";
    case 1: return "<geometry><sphere>" + radius + "</sphere></geometry>\n";
    case 2: return "<geometry><cylinder>" + radius + length + "</cylinder></geometry>\n";
    case 3: return "<geometry><capsule>" + (chance(0.8) ? radius : "") + length + "</capsule></geometry>\n";
    default: return "<geometry><plane><normal>" + numbers(3, -1, 1) + "</normal><size>" + numbers(2, 1, 9) + "</size></plane></geometry>\n";
  }
}

std::string RandomWorld::colour() { return numbers(chance(0.5) ? 3 : 4, 0, 1); }

std::string RandomWorld::material() {
  if (chance(0.3)) return "";
  std::string text = "<material>";
  for (const char* each : {"ambient", "diffuse", "specular", "emissive"})
    if (chance(0.7)) text += "<" + std::string(each) + ">" + colour() + "</" + each + ">";
  return text + "</material>\n";
}

// Principal moments of 1 to 1.5 with small products are those of a body.
std::string RandomWorld::inertial() {
  std::string text = "<inertial>";
  if (chance(0.6)) text += "<pose>" + numbers(3, -1, 1) + " " + numbers(3, -3, 3) + "</pose>";
  text += "<mass>" + numbers(1, 0.1, 9) + "</mass><inertia>";
  for (const char* each : {"ixx", "iyy", "izz"}) text += "<" + std::string(each) + ">" + numbers(1, 1, 1.4) + "</" + each + ">";
  for (const char* each : {"ixy", "ixz", "iyz"}) text += "<" + std::string(each) + ">" + numbers(1, -0.05, 0.05) + "</" + each + ">";
  return text + "</inertia></inertial>\n";
}

std::string RandomWorld::link(const std::string& link_name, Scope& scope) {
  std::string text = "<link name=\"" + link_name + "\">\n" + pose(&scope) + inertial();
  for (const char* kind : {"collision", "visual"})
    for (int i = below(3); i > 0; --i) {
      Scope none;
      none.version = scope.version;
      if (scope.version >= 8) none.frames = scope.frames;
      text += "<" + std::string(kind) + " name=\"" + name("s") + "\">" + pose(&none) + geometry() +
              (std::string(kind) == "visual" ? material() : "") + "</" + kind + ">\n";
    }
  if (chance(0.1)) text += "<gravity>false</gravity>";
  if (chance(0.1)) text += light();
  scope.frames.push_back(link_name);
  scope.ends.emplace_back(link_name, link_name);
  return text + "</link>\n";
}

std::string RandomWorld::axis(const std::string& element, const Scope& scope) {
  std::string attributes, more;
  if (scope.version >= 7 && chance(0.5))
    attributes = " expressed_in=\"" + (chance(0.3) ? "__model__" : scope.frames[static_cast<std::size_t>(below(scope.frames.size()))]) + "\"";
  if ((scope.version == 5 || scope.version == 6) && chance(0.7))
    more = "<use_parent_model_frame>" + std::string(chance(0.5) ? "true" : "0") + "</use_parent_model_frame>";
  if (chance(0.7)) more += "<limit><lower>" + numbers(1, -2, 0) + "</lower><upper>" + numbers(1, 0, 2) + "</upper></limit>";
  if (chance(0.5))
    more += "<dynamics><damping>" + numbers(1, 0, 1) + "</damping><friction>" + numbers(1, 0, 1) + "</friction><spring_stiffness>" +
            numbers(1, 0, 1) + "</spring_stiffness><spring_reference>" + numbers(1, -1, 1) + "</spring_reference></dynamics>";
  return "<" + element + "><xyz" + attributes + ">" + numbers(3, -1, 1) + "</xyz>" + more + "</" + element + ">\n";
}

std::string RandomWorld::joint(Scope& scope) {
  const auto child = scope.ends[static_cast<std::size_t>(below(scope.ends.size()))];
  const auto parent = scope.ends[static_cast<std::size_t>(below(scope.ends.size()))];
  if (child.second.empty() || (!parent.second.empty() && child.second == parent.second)) return "";
  const bool to_world = chance(0.2);
  if (!to_world && parent.second.empty()) return "";
  const char* types[] = {"fixed", "revolute", "continuous", "prismatic", "universal", "ball"};
  const std::string type = types[below(6)], joint_name = name("j");
  std::string text = "<joint name=\"" + joint_name + "\" type=\"" + type + "\">\n<parent>" + (to_world ? "world" : parent.first) + "</parent><child>" + child.first + "</child>\n" + pose(&scope);
  if (type != "fixed" && type != "ball") text += axis("axis", scope);
  if (type == "universal") text += axis("axis2", scope);
  scope.frames.push_back(joint_name);
  return text + "</joint>\n";
}

std::string RandomWorld::frame(Scope& scope) {
  if (scope.version < 7) return "";
  const std::string frame_name = name("f");
  std::string attached, body;
  if (!scope.ends.empty() && chance(0.6)) {
    const auto& end = scope.ends[static_cast<std::size_t>(below(scope.ends.size()))];
    attached = " attached_to=\"" + end.first + "\"", body = end.second;
  }
  const std::string text = "<frame name=\"" + frame_name + "\"" + attached + ">" + pose(&scope) + "</frame>\n";
  scope.frames.push_back(frame_name);
  if (!body.empty()) scope.ends.emplace_back(frame_name, body);
  return text;
}

std::string RandomWorld::light() {
  const char* types[] = {"point", "spot", "directional"};
  const std::string type = types[below(3)];
  std::string text = "<light name=\"" + name("lamp") + "\" type=\"" + type + "\">" + pose(nullptr) + "<diffuse>" + colour() + "</diffuse>";
  if (chance(0.5)) text += "<specular>" + colour() + "</specular>";
  if (chance(0.5)) text += "<attenuation><range>" + numbers(1, 1, 9) + "</range><linear>" + numbers(1, 0, 1) + "</linear></attenuation>";
  if (type != "point") text += "<direction>" + numbers(3, -1, 1) + "</direction>";
  if (type == "spot") text += "<spot><inner_angle>" + numbers(1, 0, 1) + "</inner_angle><outer_angle>" + numbers(1, 1, 2) + "</outer_angle><falloff>1</falloff></spot>";
  return text + (chance(0.5) ? "<cast_shadows>true</cast_shadows>" : "") + "</light>\n";
}

std::string RandomWorld::model(const std::string& model_name, int version, int depth, const Scope* inside, std::string& first_link) {
  Scope scope;
  scope.version = version;
  std::string text;
  const bool is_static = chance(0.15);
  for (int i = 1 + below(3); i > 0; --i) {
    const std::string link_name = name("l");
    if (first_link.empty()) first_link = link_name;
    text += link(link_name, scope);
    text += frame(scope);
  }
  if (depth > 0 && version >= 7 && chance(0.5)) {
    std::string inner;
    const std::string nested = name("m");
    text += model(nested, version, depth - 1, &scope, inner);
    scope.frames.push_back(nested);
    if (version >= 8) {
      scope.frames.push_back(nested + "::" + inner);
      scope.ends.emplace_back(nested + "::" + inner, nested + "::" + inner);
    }
  }
  if (depth > 0 && version == 9 && chance(0.4)) text += include(scope, chance(0.5));
  text += frame(scope);
  if (!is_static)
    for (int i = below(3); i > 0; --i) text += joint(scope);
  text += frame(scope);
  std::string attributes;
  if (version >= 8 && may_place_ && chance(0.3)) attributes = " placement_frame=\"" + scope.frames[static_cast<std::size_t>(below(scope.frames.size()))] + "\"";
  Scope none;
  none.version = version;
  return "<model name=\"" + model_name + "\"" + attributes + ">\n" + pose(inside ? inside : &none) + (is_static ? "<static>true</static>\n" : "") +
         (chance(0.2) ? "<self_collide>true</self_collide>\n" : "") + text + "</model>\n";
}

std::string RandomWorld::include(Scope& scope, bool merge) {
  const std::string file = name("part") + ".sdf", own = name("m");
  std::string first;
  const int version = 4 + below(6);
  may_place_ = !merge;
  files_[file] = file_of(version, model(own, version, 0, nullptr, first));
  may_place_ = true;
  std::string text = "<include" + std::string(merge ? " merge=\"true\"" : "") + "><uri>" + file + "</uri>\n";
  std::string used = own;
  if (chance(0.5)) text += "<name>" + (used = name("m")) + "</name>\n";
  std::string placed = pose(&scope);
  // libsdformat rounds the pose of a merged model to six digits of its Euler angles: these are exact in six digits.
  if (merge) placed = "<pose" + frame_attribute(scope) + ">0.25 -1.5 " + std::to_string(below(9)) + " 0.5 -0.75 " + std::to_string(below(3)) + "</pose>\n";
  text += placed;
  if (!merge && !placed.empty() && chance(0.3)) text += "<placement_frame>" + first + "</placement_frame>\n";
  if (!merge && chance(0.2)) text += "<static>true</static>\n";
  const std::string prefix = merge ? "" : used + "::";
  if (!merge) scope.frames.push_back(used);
  scope.frames.push_back(prefix + first);
  // The model may be static, where a joint has no effect.
  return text + "</include>\n";
}

std::string RandomWorld::world() {
  Scope scope;
  scope.version = 4 + below(6);
  std::string text = chance(0.3) && scope.version > 5 ? "<gravity>" + numbers(3, -9, 9) + "</gravity>\n" : "";
  if (scope.version <= 5 && chance(0.5)) text += "<physics type=\"ode\"><gravity>" + numbers(3, -9, 9) + "</gravity></physics>\n";
  for (int i = below(3); i > 0; --i) text += light();
  for (int i = 1 + below(2); i > 0; --i) {
    text += frame(scope);
    std::string first;
    const std::string model_name = name("m");
    text += model(model_name, scope.version, 2, &scope, first);
    scope.frames.push_back(model_name);
    if (scope.version >= 8) scope.frames.push_back(model_name + "::" + first);
  }
  if (chance(0.5)) text += include(scope, false);
  return file_of(scope.version, "<world name=\"w\">\n" + text + "</world>\n");
}

}  // namespace tactus::test
