#include "sim_node/scene/meshes/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "sim_node/scene/meshes/gltf_document.h"
#include "sim_node/scene/meshes/gltf_reader.h"

namespace tactus::sim {
namespace {

using nlohmann::json;

constexpr int kIndexType = 5125, kNumberType = 5126;  // unsigned int and float; glTF 2.0, 3.6.2.2
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;      // 3.6 and 5.11

json colour(const Eigen::Vector3f& c) { return json::array({c.x(), c.y(), c.z()}); }

struct Writer {
  json document = {{"asset", {{"version", "2.0"}, {"generator", "Tactus convert_geometry"}}}, {"scene", 0}};
  sync::Bytes buffer;
  std::vector<MeshPicture> pictures;

  int add_view(const void* data, std::size_t bytes, int target) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes}};
    if (target) view["target"] = target;
    const auto* begin = static_cast<const std::uint8_t*>(data);
    buffer.insert(buffer.end(), begin, begin + bytes);
    document["bufferViews"].push_back(view);
    return static_cast<int>(document["bufferViews"].size()) - 1;
  }

  int add_accessor(const void* data, std::size_t count, int component, const char* type,
                   std::size_t element_bytes) {
    json accessor = {{"componentType", component}, {"count", count}, {"type", type}};
    accessor["bufferView"] =
        add_view(data, count * element_bytes, component == kNumberType ? kArrayBuffer : kElementArrayBuffer);
    document["accessors"].push_back(accessor);
    return static_cast<int>(document["accessors"].size()) - 1;
  }

  template <int N>
  int add_vectors(const std::vector<Eigen::Matrix<float, N, 1>>& list) {
    std::vector<float> flat;
    for (const auto& v : list) flat.insert(flat.end(), v.data(), v.data() + N);
    const char* type = N == 2 ? "VEC2" : N == 3 ? "VEC3" : "VEC4";
    return add_accessor(flat.data(), list.size(), kNumberType, type, sizeof(float) * N);
  }

  json add_attributes(const MeshPart& part) {
    json attributes;
    attributes["POSITION"] = add_vectors<3>(part.positions_m);
    Eigen::Vector3f low = part.positions_m.front(), high = low;
    for (const auto& p : part.positions_m) low = low.cwiseMin(p), high = high.cwiseMax(p);
    document["accessors"].back()["min"] = colour(low), document["accessors"].back()["max"] = colour(high);
    if (!part.normals.empty()) attributes["NORMAL"] = add_vectors<3>(part.normals);
    if (!part.tangents.empty()) attributes["TANGENT"] = add_vectors<4>(part.tangents);
    if (part.texcoords.empty()) return attributes;
    std::vector<Eigen::Vector2f> downwards = part.texcoords;
    std::vector<float> exact;
    bool rounds = false;
    for (Eigen::Vector2f& t : downwards) {
      exact.push_back(t.y());
      t.y() = 1 - t.y();
      rounds = rounds || 1 - t.y() != exact.back();
    }
    attributes["TEXCOORD_0"] = add_vectors<2>(downwards);
    if (rounds) attributes[kExactV] = add_accessor(exact.data(), exact.size(), kNumberType, "SCALAR", sizeof(float));
    return attributes;
  }

  // Adds each picture once; returns the index of its texture, -1 for none.
  int add_picture(const MeshPicture& picture) {
    if (picture.none()) return -1;
    const auto known = std::find(pictures.begin(), pictures.end(), picture);
    const int index = static_cast<int>(known - pictures.begin());
    if (known != pictures.end()) return index;
    pictures.push_back(picture);
    json image;
    if (picture.bytes.empty()) {
      image["uri"] = encode_path(picture.file);
    } else {
      image["bufferView"] = add_view(picture.bytes.data(), picture.bytes.size(), 0);
      image["mimeType"] = picture.bytes[0] == 0xff ? "image/jpeg" : "image/png";
    }
    document["images"].push_back(image);
    document["textures"].push_back({{"source", index}});
    return index;
  }

  void add_material(const MeshMaterial& m) {
    json pbr = {{"metallicFactor", 0.0}};
    pbr["baseColorFactor"] = colour(m.diffuse);
    pbr["baseColorFactor"].push_back(m.alpha);
    // Roughness of a highlight of equal width for other readers; our reader uses the exponent in the extras.
    pbr["roughnessFactor"] = std::pow(2.0 / (static_cast<double>(m.shininess) + 2), 0.25);
    if (const int texture = add_picture(m.colour_map); texture >= 0)
      pbr["baseColorTexture"] = {{"index", texture}};
    json material = {{"pbrMetallicRoughness", pbr}, {"emissiveFactor", colour(m.emissive)}};
    if (!m.name.empty()) material["name"] = m.name;
    if (m.alpha < 1) material["alphaMode"] = "BLEND";
    if (const int texture = add_picture(m.normal_map); texture >= 0)
      material["normalTexture"] = {{"index", texture}};
    material["extras"]["tactus"] = {{"specular", colour(m.specular)}, {"shininess", m.shininess}};
    document["materials"].push_back(material);
  }

  void add_part(const MeshPart& part, const json& extras) {
    const std::vector<std::uint32_t> corners(part.indices.begin(), part.indices.end());
    json primitive;
    primitive["attributes"] = add_attributes(part);
    primitive["indices"] =
        add_accessor(corners.data(), corners.size(), kIndexType, "SCALAR", sizeof(std::uint32_t));
    if (part.material >= 0) primitive["material"] = part.material;
    json mesh = {{"primitives", json::array({primitive})}}, node;
    if (!part.mesh.empty()) mesh["name"] = part.mesh;
    if (!part.node.empty()) node["name"] = part.node;
    node["mesh"] = document["meshes"].size();
    if (!extras.is_null()) node["extras"]["tactus"] = extras;
    document["scenes"][0]["nodes"].push_back(document["nodes"].size());
    document["meshes"].push_back(mesh);
    document["nodes"].push_back(node);
  }
};

void append(sync::Bytes& out, std::uint32_t value) {
  for (int k = 0; k < 4; ++k) out.push_back(static_cast<std::uint8_t>(value >> 8 * k));
}

void append_chunk(sync::Bytes& out, std::uint32_t kind, const std::uint8_t* data, std::size_t size,
                  std::uint8_t filler) {
  append(out, static_cast<std::uint32_t>((size + 3) / 4 * 4));
  append(out, kind);
  out.insert(out.end(), data, data + size);
  while (out.size() % 4) out.push_back(filler);
}

}  // namespace

sync::Bytes write_gltf(const MeshParts& mesh, bool packed) {
  Writer writer;
  for (const MeshMaterial& material : mesh.materials) writer.add_material(material);
  json extras;
  if (!mesh.material.empty()) extras["material"] = mesh.material;
  if (!mesh.look.empty()) extras["look"] = mesh.look;
  for (const MeshPart& part : mesh.parts)
    if (!part.positions_m.empty()) writer.add_part(part, extras);
  json buffer = {{"byteLength", writer.buffer.size()}};
  if (!packed) buffer["uri"] = "data:application/octet-stream;base64," + encode_base64(writer.buffer);
  writer.document["buffers"].push_back(buffer);
  // Bytes that are not UTF-8 are replaced by a marker in names.
  const std::string text = writer.document.dump(packed ? -1 : 1, ' ', false, json::error_handler_t::replace);
  if (!packed) return {text.begin(), text.end()};
  sync::Bytes out{'g', 'l', 'T', 'F'};
  append(out, 2);
  append(out, 0);  // the length, set below
  append_chunk(out, 0x4e4f534a, reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), ' ');
  append_chunk(out, 0x004e4942, writer.buffer.data(), writer.buffer.size(), 0);
  const auto length = static_cast<std::uint32_t>(out.size());
  std::memcpy(out.data() + 8, &length, sizeof length);
  return out;
}

}  // namespace tactus::sim
