#include "sim_node/scene/visuals.h"

#include <algorithm>
#include <stdexcept>
#include <tactus/asset_ref_t.hpp>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/sdf/attributes.h"
#include "sim_node/scene/meshes/file_properties.h"
#include "sim_node/scene/materials/height_image.h"
#include "sim_node/scene/meshes.h"
#include "sim_node/scene/materials/pictures.h"
#include "sim_node/scene/sdf/values.h"
#include "sim_node/scene/shapes.h"
#include "sim_node/scene/extensions/tactus_looks.h"
#include "sync/text/settings.h"

namespace tactus::sim {
namespace {

// Colours of the script materials of Gazebo classic, which its worlds refer to by name; our approximations.
const std::map<std::string, Eigen::Vector3d> kScripts{
    {"Gazebo/Grey", {0.5, 0.5, 0.5}},   {"Gazebo/DarkGrey", {0.2, 0.2, 0.2}}, {"Gazebo/White", {0.9, 0.9, 0.9}},
    {"Gazebo/Black", {0.02, 0.02, 0.02}}, {"Gazebo/Red", {0.8, 0.05, 0.05}},  {"Gazebo/Green", {0.05, 0.7, 0.05}},
    {"Gazebo/Blue", {0.05, 0.05, 0.8}}, {"Gazebo/Yellow", {0.9, 0.9, 0.05}},  {"Gazebo/Orange", {1, 0.5, 0.05}},
    {"Gazebo/Purple", {0.6, 0.05, 0.6}}, {"Gazebo/Turquoise", {0.05, 0.8, 0.8}}, {"Gazebo/Gold", {0.8, 0.65, 0.1}},
    {"Gazebo/Wood", {0.5, 0.32, 0.17}}};

constexpr double kPlaceholder_m = 0.1;  // edge of the box that stands for a mesh (design)

// Appearance of a visual as SDF defines it.
struct Appearance {
  VisualDef def;
  bool coloured = false;  // SDF defines the colours; those of the mesh file are ignored
  LookAttributes look;
};

// The maps of <pbr>, for both of its workflows.
LookAttributes read_pbr(LoadContext& context, const sdf::Element& material) {
  LookAttributes words;
  const sdf::Element* pbr = material.child("pbr");
  const sdf::Element* workflow = sdf::child_of(pbr, "metal");
  if (!workflow) workflow = sdf::child_of(pbr, "specular");
  const auto picture = [&](const char* name, PictureUse use) -> std::optional<std::int64_t> {
    const sdf::Element* element = sdf::child_of(workflow, name);
    if (!element || element->text.empty()) return std::nullopt;
    const std::string uri(element->text);
    // Third-party worlds name pictures that are on remote servers.
    if (context.files.find(uri, element->source->file).empty()) {
      context.warn(*element, "names \"" + uri + "\", which is not found: drawn without it");
      return std::nullopt;
    }
    return picture_of(context, *element, "picture", uri, use);
  };
  words.colour_map = picture("albedo_map", PictureUse::kColour);
  words.normal_map = picture("normal_map", PictureUse::kDirections);
  return words;
}

void read_script(const LoadContext& context, const sdf::Element& material, Appearance& a) {
  const sdf::Element* script = material.child("script");
  if (!script) return;
  const sdf::Element* named = script->child("name");
  const std::string name(named ? named->text : "");
  const auto known = kScripts.find(name);
  a.coloured = true;
  if (known != kScripts.end())
    a.def.ambient = a.def.diffuse = known->second;
  else if (!material.child("diffuse"))
    context.warn(*script, "names \"" + name + "\", whose colour is unknown: shown in grey");
}

void read_material(LoadContext& context, const sdf::Element& visual, Appearance& a) {
  const sdf::Element* material = visual.child("material");
  if (!material) return;
  read_script(context, *material, a);
  const auto diffuse = sdf::child_colour(material, "diffuse"), ambient = sdf::child_colour(material, "ambient");
  const auto specular = sdf::child_colour(material, "specular"), emissive = sdf::child_colour(material, "emissive");
  a.coloured = a.coloured || diffuse || ambient;
  if (diffuse) a.def.diffuse = a.def.ambient = diffuse->rgb;
  if (ambient) a.def.ambient = ambient->rgb;
  if (specular) a.def.specular = specular->rgb;
  if (emissive) a.def.emissive = emissive->rgb;
  if (diffuse) a.def.alpha *= diffuse->alpha;
  if (const sdf::Element* shininess = material->child("shininess"))  // of SDF 1.10
    a.def.shininess = std::clamp(sdf::number(*shininess), 1.0, 1e4);
  a.look.add(read_pbr(context, *material));
}

Appearance read_appearance(LoadContext& context, const sdf::Element& visual, int body, int material) {
  Appearance a;
  a.def.shape.name = visual.value("name"), a.def.shape.body = body, a.def.shape.material = material;
  // In single precision, as SDF defines it.
  const auto transparency = static_cast<float>(sdf::child_number(&visual, "transparency", 0));
  a.def.alpha = std::clamp(1.0 - static_cast<double>(transparency), 0.0, 1.0);
  if (const sdf::Element* look = visual.child("tactus:look"))
    a.look = read_visual_look(context, *look);
  read_material(context, visual, a);
  return a;
}

// A colour map without a colour is shown unchanged.
void complete_appearance(LoadContext& context, Appearance& a) {
  if (!a.coloured && a.look.colour_map.value_or(0) != 0) a.def.diffuse = a.def.ambient = Eigen::Vector3d::Ones();
  a.def.look = look_index(context, a.look);
}

// A picture that a mesh file names or contains. Empty, with a warning, when it is missing, because files are often
// distributed without their pictures.
std::optional<std::int64_t> picture_of_file(LoadContext& context, const sdf::Element& element, const NamedMesh& named,
                                            const MeshPicture& picture, PictureUse use) {
  if (picture.none()) return std::nullopt;
  const std::string name = picture.file.empty() ? "a picture inside it" : "picture \"" + picture.file.substr(0, 200) + "\"";
  try {
    sync::Asset image{asset_ref_t::IMAGE, named.file.filename().string(), picture.bytes};
    if (!picture.file.empty()) {
      const std::filesystem::path file = named.file.parent_path() / picture.file;
      std::error_code error;
      if (std::filesystem::exists(file, error) && !context.files.readable().resolve(file))
        throw std::runtime_error("it is hidden or outside the folder of the scene");
      image.name = file.filename().string();
      image.bytes = read_image_file(file);
    }
    check_picture(image.bytes, use);
    return add_image(context.world, std::move(image));
  } catch (const std::exception& e) {
    context.warn(element, "names mesh \"" + named.uri + "\", whose material names " + name + ": " + e.what() +
                              "; drawn without it");
    return std::nullopt;
  }
}

// Adds the values of the file that SDF does not define.
Appearance with_file_appearance(LoadContext& context, const sdf::Element& element, const NamedMesh& named, const LookAttributes& file_look,
                     int material, Appearance a) {
  a.look.add(file_look);
  if (material >= 0 && static_cast<std::size_t>(material) < named.parts->materials.size()) {
    const MeshMaterial& m = named.parts->materials[static_cast<std::size_t>(material)];
    if (!a.coloured) {
      a.def.diffuse = a.def.ambient = m.diffuse.cast<double>();
      a.def.specular = m.specular.cast<double>(), a.def.emissive = m.emissive.cast<double>();
      a.def.shininess = static_cast<double>(m.shininess);
      a.def.alpha *= static_cast<double>(m.alpha);
      a.coloured = true;
    }
    if (!a.look.colour_map) a.look.colour_map = picture_of_file(context, element, named, m.colour_map, PictureUse::kColour);
    if (!a.look.normal_map) a.look.normal_map = picture_of_file(context, element, named, m.normal_map, PictureUse::kDirections);
  }
  complete_appearance(context, a);
  return a;
}

bool same(const VisualDef& a, const VisualDef& b) {
  return a.ambient == b.ambient && a.diffuse == b.diffuse && a.specular == b.specular && a.emissive == b.emissive &&
         a.shininess == b.shininess && a.alpha == b.alpha && a.look == b.look;
}

// Number of subdivisions that the visual requests.
int read_display(const LoadContext& context, const sdf::Element& visual) {
  const sdf::Element* display = visual.child("tactus:display");
  if (!display) return 0;
  Attributes attributes(context, *display);
  const double times = attributes.required_quantity("subdivide", "1", 0, 6);
  attributes.done();
  if (times != std::floor(times)) context.reject(*display, "has a subdivide that is not a whole number");
  return static_cast<int>(times);
}

// A visual whose mesh is not there: a file that its author has, or one on a server. False when the mesh is there.
bool add_placeholder(LoadContext& context, const sdf::Element& mesh, const Appearance& appearance) {
  const sdf::Element* uri = mesh.child("uri");
  if (!uri || uri->text.empty() || !context.files.find(std::string(uri->text), mesh.source->file).empty()) return false;
  context.warn(mesh, "names \"" + std::string(uri->text) +
                         "\", which is not found: a magenta box is shown in its place; put the file beside the scene file");
  VisualDef box = appearance.def;
  box.shape.kind = ShapeKind::kBox;
  box.shape.size_m.setConstant(kPlaceholder_m);
  box.ambient = box.diffuse = Eigen::Vector3d(1, 0, 1);
  box.emissive = Eigen::Vector3d(0.5, 0, 0.5);  // visible without light
  box.specular.setZero();
  box.alpha = 1;
  box.look = -1;
  context.placeholders.insert(context.world.visuals.size());
  context.world.visuals.push_back(box);
  return true;
}

void add_mesh_visual(LoadContext& context, const sdf::Element& element, Appearance appearance, int subdivide) {
  if (add_placeholder(context, element, appearance)) return;
  const NamedMesh named = named_mesh(context, element);
  ShapeDef& shape = appearance.def.shape;
  shape.kind = ShapeKind::kMesh;
  if (shape.material < 0) shape.material = material_of_file(context, named, -1);
  LookAttributes file_look;
  if (!named.parts->look.empty()) file_look = read_visual_look(context, element_of("tactus:look", named.parts->look, named.file)->element);

  // Materials with equal appearance are merged.
  std::set<int> seen;
  std::vector<std::pair<VisualDef, std::set<int>>> kinds;
  for (const MeshPart& part : named.parts->parts) {
    if (!is_selected(part, named.selection) || part.indices.empty() || !seen.insert(part.material).second)
      continue;
    const VisualDef def = with_file_appearance(context, element, named, file_look, part.material, appearance).def;
    const auto known = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return same(kind.first, def); });
    if (known != kinds.end()) known->second.insert(part.material);
    else kinds.emplace_back(def, std::set<int>{part.material});
  }
  if (kinds.empty()) whole_mesh(context, named, element);  // throws with the reason
  for (auto& [def, materials] : kinds) {
    // Without a look, texture coordinates are not needed, and the mesh is shared with the collision.
    const bool shared = kinds.size() == 1 && def.look < 0 && subdivide == 0;
    def.shape.mesh = shared ? whole_mesh(context, named, element) : display_mesh(context, named, materials, subdivide, element);
    context.world.visuals.push_back(def);
  }
}

}  // namespace

void add_visuals(LoadContext& context, const sdf::Element& link, int body, int material) {
  for (const sdf::Element& visual : link.children("visual")) {
    const Eigen::Isometry3d pose = context.resolve(visual);
    const int subdivide = read_display(context, visual);
    Appearance appearance = read_appearance(context, visual, body, material);
    const sdf::Element* geometry = geometry_of(visual);
    if (geometry && geometry->name == "mesh") {
      appearance.def.shape.pose = pose;
      add_mesh_visual(context, *geometry, std::move(appearance), subdivide);
      continue;
    }
    if (subdivide > 0)
      context.reject(visual, "has a subdivide for another shape than a <mesh>: only a <mesh> has triangles to divide");
    const auto shape = read_shape(context, visual, pose);
    if (!shape) continue;
    const ShapeDef named = appearance.def.shape;
    appearance.def.shape = *shape;
    appearance.def.shape.name = named.name, appearance.def.shape.body = named.body, appearance.def.shape.material = named.material;
    complete_appearance(context, appearance);
    context.world.visuals.push_back(appearance.def);
  }
}

}  // namespace tactus::sim
