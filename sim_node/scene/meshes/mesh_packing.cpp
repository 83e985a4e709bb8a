#include "sim_node/scene/meshes/mesh_packing.h"

#include <stdexcept>

#include "sync/sandbox/records.h"

namespace tactus::sim {
namespace {

void put(sync::Packer& to, const MeshPicture& picture) {
  to.put_list(picture.file);
  to.put_list(picture.bytes);
}

MeshPicture get_picture(sync::Unpacker& from) {
  MeshPicture picture;
  picture.file = from.get_list<std::string>();
  picture.bytes = from.get_list<sync::Bytes>();
  return picture;
}

// Fixed Eigen vectors have a copy constructor of their own, so their numbers are packed one by one.
template <int N>
void put_vectors(sync::Packer& to, const std::vector<Eigen::Matrix<float, N, 1>>& list) {
  std::vector<float> numbers;
  numbers.reserve(list.size() * N);
  for (const auto& v : list) numbers.insert(numbers.end(), v.data(), v.data() + N);
  to.put_list(numbers);
}

template <int N>
std::vector<Eigen::Matrix<float, N, 1>> get_vectors(sync::Unpacker& from) {
  const auto numbers = from.get_list<std::vector<float>>();
  std::vector<Eigen::Matrix<float, N, 1>> list;
  list.reserve(numbers.size() / N);
  for (std::size_t i = 0; i + N <= numbers.size(); i += N) list.emplace_back(numbers.data() + i);
  return list;
}

void put_colour(sync::Packer& to, const Eigen::Vector3f& colour) {
  for (const int i : {0, 1, 2}) to.put(colour[i]);
}

// Clamped to its range, because the reader may return any bits.
float get_number(sync::Unpacker& from, float min, float max) {
  const auto value = from.get<float>();
  return value > min ? std::min(value, max) : min;
}

Eigen::Vector3f get_colour(sync::Unpacker& from) {
  Eigen::Vector3f colour;
  for (const int i : {0, 1, 2}) colour[i] = get_number(from, 0, 1);
  return colour;
}

void put(sync::Packer& to, const Properties& properties) {
  to.put(static_cast<std::uint64_t>(properties.size()));
  for (const auto& [key, value] : properties) to.put_list(key), to.put_list(value);
}

Properties get_properties(sync::Unpacker& from) {
  Properties properties;
  for (std::size_t left = from.get_count(2 * sizeof(std::uint64_t)); left > 0; --left) {
    std::string key = from.get_list<std::string>();
    properties[std::move(key)] = from.get_list<std::string>();
  }
  return properties;
}

}  // namespace

std::vector<std::uint8_t> pack(const MeshParts& mesh) {
  sync::Packer to;
  to.put(static_cast<std::uint64_t>(mesh.parts.size()));
  for (const MeshPart& part : mesh.parts) {
    to.put_list(part.mesh), to.put_list(part.node);
    to.put(part.material);
    put_vectors<3>(to, part.positions_m), put_vectors<3>(to, part.normals);
    put_vectors<2>(to, part.texcoords), put_vectors<4>(to, part.tangents);
    to.put_list(part.indices);
  }
  to.put(static_cast<std::uint64_t>(mesh.materials.size()));
  for (const MeshMaterial& m : mesh.materials) {
    to.put_list(m.name);
    put_colour(to, m.diffuse), put_colour(to, m.specular), put_colour(to, m.emissive);
    to.put(m.shininess), to.put(m.alpha);
    put(to, m.colour_map), put(to, m.normal_map);
  }
  put(to, mesh.material), put(to, mesh.look);
  return to.take();
}

MeshParts unpack_mesh(std::span<const std::uint8_t> bytes) {
  sync::Unpacker from(bytes);
  MeshParts mesh;
  mesh.parts.resize(from.get_count(7 * sizeof(std::uint64_t)));
  for (MeshPart& part : mesh.parts) {
    part.mesh = from.get_list<std::string>(), part.node = from.get_list<std::string>();
    part.material = from.get<int>();
    part.positions_m = get_vectors<3>(from), part.normals = get_vectors<3>(from);
    part.texcoords = get_vectors<2>(from), part.tangents = get_vectors<4>(from);
    part.indices = from.get_list<std::vector<int>>();
  }
  mesh.materials.resize(from.get_count(3 * sizeof(std::uint64_t)));
  for (MeshMaterial& m : mesh.materials) {
    m.name = from.get_list<std::string>();
    m.diffuse = get_colour(from), m.specular = get_colour(from), m.emissive = get_colour(from);
    m.shininess = get_number(from, 1, 1e4f), m.alpha = get_number(from, 0, 1);
    m.colour_map = get_picture(from), m.normal_map = get_picture(from);
  }
  mesh.material = get_properties(from), mesh.look = get_properties(from);
  if (!from.at_end()) throw std::runtime_error("its reader returned more than a mesh");
  return mesh;
}

}  // namespace tactus::sim
