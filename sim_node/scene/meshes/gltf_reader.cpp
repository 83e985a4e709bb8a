#include "sim_node/scene/meshes/gltf_reader.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim_node/scene/meshes/corner_normals.h"
#include "sim_node/scene/meshes/gltf_document.h"

namespace tactus::sim {
namespace {

using nlohmann::json;

// Longer than any property value: a path, or a few numbers.
constexpr std::size_t kMaxPropertyBytes = 4096, kMaxProperties = 64;

Eigen::Vector3f colour(const json& object, const char* member, const Eigen::Vector3f& missing) {
  const json& list = member_of(object, member);
  if (!list.is_array() || list.size() < 3) return missing;
  Eigen::Vector3f c;
  for (std::size_t i = 0; i < 3; ++i)
    c[static_cast<int>(i)] = list[i].is_number() ? static_cast<float>(std::clamp(list[i].get<double>(), 0.0, 1.0)) : 0.0f;
  return c;
}

// Number in [low, high]; `missing` when there is none.
float bounded(const json& object, const char* member, float missing, double low, double high) {
  return static_cast<float>(std::clamp(number_of(object, member, static_cast<double>(missing)), low, high));
}

// bytes: total of all pictures inside the file. A file may name one picture many times.
MeshPicture picture(const GltfDocument& document, const json& info, std::size_t& bytes_so_far) {
  const auto check = [&](std::size_t more) {
    if ((bytes_so_far += more) > kMaxPictureBytes)
      throw std::runtime_error("its pictures are larger than " + std::to_string(kMaxPictureBytes >> 20) + " MiB together");
  };
  const int texture = index_of(info, "index");
  if (texture < 0) return {};
  const int source = index_of(document.entry("textures", texture), "source");
  if (source < 0) return {};
  const json& image = document.entry("images", source);
  if (const int view = index_of(image, "bufferView"); view >= 0) {
    const auto bytes = document.view(view);
    check(bytes.size());
    return {"", {bytes.begin(), bytes.end()}};
  }
  const std::string uri = text_of(image, "uri");
  check(uri.size());
  sync::Bytes bytes;
  if (decode_data_uri(uri, bytes)) return {"", std::move(bytes)};
  return {decode_path(uri), {}};
}

MeshMaterial read_material(const GltfDocument& document, const json& from, std::size_t& picture_bytes) {
  MeshMaterial m;
  m.name = text_of(from, "name");
  const json& pbr = member_of(from, "pbrMetallicRoughness");
  m.diffuse = colour(pbr, "baseColorFactor", m.diffuse);
  m.emissive = colour(from, "emissiveFactor", m.emissive);
  if (text_of(from, "alphaMode") == "BLEND") {
    const json& factor = member_of(pbr, "baseColorFactor");
    if (factor.is_array() && factor.size() == 4 && factor[3].is_number())
      m.alpha = static_cast<float>(std::clamp(factor[3].get<double>(), 0.0, 1.0));
  }
  // Converts the roughness r of glTF to a Phong exponent of equal width: 2 / r^4 - 2 (Walter et al. 2007, eq. 30,
  // with glTF's alpha = r^2). Reflectance at normal incidence: 0.04 for a dielectric (glTF 2.0, B.2.1).
  const double roughness = std::clamp(number_of(pbr, "roughnessFactor", 1), 0.1, 1.0);
  m.shininess = static_cast<float>(std::clamp(2 / std::pow(roughness, 4) - 2, 1.0, 1e4));
  m.specular.setConstant(0.04f);
  const json& extras = member_of(member_of(from, "extras"), "tactus");
  m.specular = colour(extras, "specular", m.specular);
  m.shininess = bounded(extras, "shininess", m.shininess, 1, 1e4);
  m.colour_map = picture(document, member_of(pbr, "baseColorTexture"), picture_bytes);
  m.normal_map = picture(document, member_of(from, "normalTexture"), picture_bytes);
  return m;
}

Properties read_properties(const json& extras, const char* member) {
  Properties properties;
  const json& from = member_of(extras, member);
  if (!from.is_object()) return properties;
  for (const auto& [name, value] : from.items())
    if (value.is_string() && value.get_ref<const std::string&>().size() <= kMaxPropertyBytes &&
        name.size() <= 64 && properties.size() < kMaxProperties)
      properties[name] = value.get<std::string>();
  return properties;
}

// Three corners per triangle, from lists, strips and fans (glTF 2.0, 3.7.2.1).
std::vector<int> triangles_of(int mode, const std::vector<int>& corners) {
  if (mode == 4 && corners.size() % 3 != 0) throw std::runtime_error("its triangles do not have three corners each");
  if (mode == 4) return corners;
  std::vector<int> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == 6)
      triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
    else
      triangles.insert(triangles.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
  }
  return triangles;
}

template <int N>
std::vector<Eigen::Matrix<float, N, 1>> vectors(const GltfDocument& document, const json& attributes,
                                                const std::string& name) {
  std::vector<Eigen::Matrix<float, N, 1>> list;
  const int accessor = index_of(attributes, name.c_str());
  if (accessor < 0) return list;
  const std::vector<float> values = document.floats(accessor, N);
  for (std::size_t i = 0; i + N <= values.size(); i += N)
    list.emplace_back(Eigen::Matrix<float, N, 1>(values.data() + i));
  return list;
}

void read_texcoords(const GltfDocument& document, const json& attributes, int set, MeshPart& part) {
  part.texcoords = vectors<2>(document, attributes, "TEXCOORD_" + std::to_string(set));
  for (Eigen::Vector2f& t : part.texcoords) t.y() = 1 - t.y();  // glTF counts from the top of the picture
  if (set != 0 || index_of(attributes, kExactV) < 0) return;
  const std::vector<float> exact = document.floats(index_of(attributes, kExactV), 1);
  for (std::size_t i = 0; i < std::min(exact.size(), part.texcoords.size()); ++i) part.texcoords[i].y() = exact[i];
}

void place(MeshPart& part, const Eigen::Affine3d& pose) {
  if (pose.matrix() == Eigen::Matrix4d::Identity()) return;  // keeps identical bits
  const Eigen::Matrix3d along = pose.linear(), turn = along.inverse().transpose();
  const bool mirrored = along.determinant() < 0;
  for (auto& p : part.positions_m) p = (pose * p.cast<double>()).cast<float>();
  for (auto& n : part.normals) n = (turn * n.cast<double>()).stableNormalized().cast<float>();
  for (auto& t : part.tangents) {
    t.head<3>() = (along * t.head<3>().cast<double>()).stableNormalized().cast<float>();
    if (mirrored) t.w() = -t.w();
  }
  if (!mirrored) return;
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) std::swap(part.indices[i + 1], part.indices[i + 2]);
}

struct Reader {
  const GltfDocument& document;
  MeshParts mesh;
  std::set<int> visited = {};  // nodes visited: each node is used once
  std::size_t corners = 0, vertices = 0, parts = 0;

  // Adds the part to the totals before anything is allocated: a file of some kilobytes may use one accessor a thousand
  // times, and an accessor without a buffer may have any count.
  void count(const json& primitive, const json& attributes) {
    const auto elements = [&](const json& object, const char* member) {
      const int accessor = index_of(object, member);
      return accessor < 0 ? std::size_t{0} : document.count(accessor);
    };
    const std::size_t positions = elements(attributes, "POSITION");
    if ((vertices += positions) > kMaxVertices)
      throw std::runtime_error("it has more than " + std::to_string(kMaxVertices) + " vertices: simplify it");
    std::size_t more = index_of(primitive, "indices") >= 0 ? elements(primitive, "indices") : positions;
    if (number_of(primitive, "mode", 4) != 4 && more > 2) more = 3 * (more - 2);  // of a strip or a fan
    if ((corners += more) / 3 > kMaxTriangles)
      throw std::runtime_error("it has more than " + std::to_string(kMaxTriangles) + " triangles: simplify it");
    if (++parts > kMaxMeshParts)
      throw std::runtime_error("it has more than " + std::to_string(kMaxMeshParts) + " parts: simplify it");
  }

  MeshPart read_part(const json& primitive) {
    const json& attributes = member_of(primitive, "attributes");
    count(primitive, attributes);
    MeshPart part;
    part.material = index_of(primitive, "material");
    part.positions_m = vectors<3>(document, attributes, "POSITION");
    for (const Eigen::Vector3f& p : part.positions_m)
      if (!p.allFinite()) throw std::runtime_error("a vertex is not finite");
    const std::size_t count = part.positions_m.size();
    if (index_of(primitive, "indices") >= 0) {
      part.indices = document.indices(index_of(primitive, "indices"));
    } else {
      for (std::size_t i = 0; i < count; ++i) part.indices.push_back(static_cast<int>(i));
    }
    for (const int i : part.indices)
      if (static_cast<std::size_t>(i) >= count)
        throw std::runtime_error("an index refers to a vertex that does not exist");
    part.indices = triangles_of(static_cast<int>(number_of(primitive, "mode", 4)), part.indices);
    part.normals = vectors<3>(document, attributes, "NORMAL");
    part.tangents = vectors<4>(document, attributes, "TANGENT");
    int set = 0;
    if (part.material >= 0) {
      const json& material = document.entry("materials", part.material);
      const json& base = member_of(member_of(material, "pbrMetallicRoughness"), "baseColorTexture");
      set = std::max(0, index_of(base.is_object() ? base : member_of(material, "normalTexture"), "texCoord"));
    }
    read_texcoords(document, attributes, set, part);
    const auto fits = [&](const auto& list) { return list.empty() || list.size() == count; };
    if (!fits(part.normals) || !fits(part.texcoords) || !fits(part.tangents))
      throw std::runtime_error("its vertices have different numbers of normals, texture coordinates or tangents");
    if (part.texcoords.empty() || part.normals.empty()) part.tangents.clear();
    if (part.normals.empty()) make_corner_normals(part, kCrease_deg);
    return part;
  }

  void add(int index, const Eigen::Affine3d& parent, int depth) {
    if (depth > 256 || !visited.insert(index).second)
      throw std::runtime_error("its nodes are not a tree, or the tree is too deep");
    const json& node = document.entry("nodes", index);
    const Eigen::Affine3d pose = parent * pose_of(node);
    read_tactus_extras(node);
    if (const int number = index_of(node, "mesh"); number >= 0) {
      const json& from = document.entry("meshes", number);
      read_tactus_extras(from);
      for (const json& primitive : member_of(from, "primitives")) {
        const double mode = number_of(primitive, "mode", 4);
        if (mode != 4 && mode != 5 && mode != 6) continue;  // points and lines
        MeshPart part = read_part(primitive);
        part.mesh = text_of(from, "name"), part.node = text_of(node, "name");
        place(part, pose);
        mesh.parts.push_back(std::move(part));
      }
    }
    for (const json& child : member_of(node, "children")) add(as_index(child), pose, depth + 1);
  }

  // If there are several entries, the first applies to the whole file, because it is one object.
  void read_tactus_extras(const json& of) {
    const json& extras = member_of(member_of(of, "extras"), "tactus");
    if (mesh.material.empty()) mesh.material = read_properties(extras, "material");
    if (mesh.look.empty()) mesh.look = read_properties(extras, "look");
  }

  static Eigen::Affine3d pose_of(const json& node) {
    const auto list = [&](const char* member, std::size_t count, double* to) {
      const json& values = member_of(node, member);
      if (values.is_null()) return false;
      if (!values.is_array() || values.size() != count)
        throw std::runtime_error(std::string("the ") + member + " of a node is not " + std::to_string(count) + " numbers");
      for (std::size_t i = 0; i < count; ++i) to[i] = values[i].is_number() ? values[i].get<double>() : NAN;
      return true;
    };
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    if (list("matrix", 16, pose.matrix().data())) return pose;  // column by column, as in Eigen
    Eigen::Vector3d translation(0, 0, 0), scale(1, 1, 1);
    Eigen::Quaterniond rotation(1, 0, 0, 0);
    list("translation", 3, translation.data());
    list("scale", 3, scale.data());
    const bool turned = list("rotation", 4, rotation.coeffs().data());  // x y z w, as in Eigen
    return Eigen::Translation3d(translation) * (turned ? rotation.normalized() : rotation) * Eigen::Scaling(scale);
  }
};

}  // namespace

MeshParts read_gltf(const std::filesystem::path& file, const sync::ReadableFolders& readable) {
  const GltfDocument document(file, readable);
  Reader reader{document, {}};
  std::size_t picture_bytes = 0;
  for (const json& material : member_of(document.root(), "materials"))
    reader.mesh.materials.push_back(read_material(document, material, picture_bytes));
  const int scene = std::max(0, index_of(document.root(), "scene"));
  if (member_of(document.root(), "scenes").empty()) throw std::runtime_error("it has no scene");
  const json& top = document.entry("scenes", scene);
  for (const json& node : member_of(top, "nodes")) reader.add(as_index(node), Eigen::Affine3d::Identity(), 0);
  return reader.mesh;
}

}  // namespace tactus::sim
