#include "sim_node/scene/meshes/gltf_document.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and is read as it lies");

// Limits for the JSON: each value uses about 50 bytes of memory, even a short one (design).
constexpr int kMaxJsonDepth = 64;
constexpr std::size_t kMaxValues = 4'000'000;

// Component types of glTF 2.0, 3.6.2.2, and their sizes in bytes.
constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;
std::size_t bytes_of(int type) {
  switch (type) {
    case kByte:
    case kUnsignedByte: return 1;
    case kShort:
    case kUnsignedShort: return 2;
    case kUnsignedInt:
    case kFloat: return 4;
    default: throw std::runtime_error("an accessor has a component type that glTF does not have");
  }
}

int components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4') return type[3] - '0';
  throw std::runtime_error("an accessor is of type \"" + type.substr(0, 16) + "\", which no vertex has");
}

template <typename T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

double component(const std::uint8_t* at, int type, bool normalised) {
  switch (type) {
    case kByte: return normalised ? std::max(load<std::int8_t>(at) / 127.0, -1.0) : load<std::int8_t>(at);
    case kUnsignedByte: return load<std::uint8_t>(at) / (normalised ? 255.0 : 1.0);
    case kShort: return normalised ? std::max(load<std::int16_t>(at) / 32767.0, -1.0) : load<std::int16_t>(at);
    case kUnsignedShort: return load<std::uint16_t>(at) / (normalised ? 65535.0 : 1.0);
    case kUnsignedInt: return load<std::uint32_t>(at);
    default: return load<float>(at);
  }
}

// A count or an offset: any value below 2^32, which no accepted file reaches.
std::size_t size_of(const json& object, const char* member) {
  const json& given = member_of(object, member);
  const double value = given.is_null() ? 0 : given.is_number() ? given.get<double>() : -1;
  if (!(value >= 0 && value < 4294967296.0) || value != std::floor(value))
    throw std::runtime_error(std::string("a ") + member + " is not a count of bytes or elements");
  return static_cast<std::size_t>(value);
}

// Splits a .glb (glTF 2.0, 4.4): returns the text of its first chunk; `binary` gets the second.
std::string unpack(const sync::Bytes& bytes, sync::Bytes& binary) {
  constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;
  if (bytes.size() < 20 || load<std::uint32_t>(bytes.data() + 4) != 2)
    throw std::runtime_error("it is not glTF 2.0");
  const std::size_t length = load<std::uint32_t>(bytes.data() + 8);
  if (length > bytes.size()) throw std::runtime_error("it is truncated");
  std::string text;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::size_t size = load<std::uint32_t>(bytes.data() + at);
    const auto kind = load<std::uint32_t>(bytes.data() + at + 4);
    if (size > length - at - 8) throw std::runtime_error("it ends within a chunk");
    const auto* begin = bytes.data() + at + 8;
    if (at == 12 && kind != kJson) throw std::runtime_error("its first chunk is not JSON");
    if (at == 12)
      text.assign(begin, begin + size);
    else if (kind == kBin && binary.empty())
      binary.assign(begin, begin + size);
    at += 8 + size;
  }
  return text;
}

}  // namespace

double number_of(const json& object, const char* member, double missing) {
  const json& value = member_of(object, member);
  return value.is_number() ? value.get<double>() : missing;
}

int as_index(const json& value) {
  const double number = value.is_number() ? value.get<double>() : -1;
  return number >= 0 && number < 1e9 && number == std::floor(number) ? static_cast<int>(number) : -1;
}

int index_of(const json& object, const char* member) {
  const json& value = member_of(object, member);
  const int index = as_index(value);
  if (index < 0 && !value.is_null()) throw std::runtime_error(std::string("a ") + member + " is not the number of an entry");
  return index;
}

std::string text_of(const json& object, const char* member) {
  const json& value = member_of(object, member);
  return value.is_string() ? value.get<std::string>() : "";
}

const json& member_of(const json& object, const char* member) {
  static const json none;
  if (!object.is_object()) return none;
  const auto at = object.find(member);
  return at == object.end() ? none : *at;
}

struct GltfDocument::Elements {
  const std::uint8_t* data = nullptr;  // null: all values are 0
  std::size_t count = 0, stride = 0;
  int type = kFloat;
  bool normalised = false;
};

GltfDocument::GltfDocument(const std::filesystem::path& file, const sync::ReadableFolders& readable) {
  const sync::Bytes bytes = sync::read_regular_file(file, kMaxMeshFileBytes);
  const bool packed = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
  const std::string text = packed ? unpack(bytes, binary_) : std::string(bytes.begin(), bytes.end());
  std::size_t values = 0;
  const auto bounded = [&](int depth, json::parse_event_t, json&) {
    if (depth > kMaxJsonDepth || ++values > kMaxValues)
      throw std::runtime_error("its JSON is too deep or has too many values");
    return true;
  };
  json_ = json::parse(text, bounded, false);
  if (!json_.is_object()) throw std::runtime_error("it is not well-formed JSON");
  if (!text_of(member_of(json_, "asset"), "version").starts_with("2."))
    throw std::runtime_error("it is not glTF 2.0");
  for (const json& needed : member_of(json_, "extensionsRequired"))
    throw std::runtime_error("it requires the extension " +
                             (needed.is_string() ? needed.get<std::string>().substr(0, 64) : "?") +
                             ", which is not supported: export it without");
  load_buffers(file.parent_path(), readable);
}

void GltfDocument::load_buffers(const std::filesystem::path& folder, const sync::ReadableFolders& readable) {
  std::size_t total = 0;
  for (const json& buffer : member_of(json_, "buffers")) {
    const std::string uri = text_of(buffer, "uri");
    sync::Bytes bytes;
    if (uri.empty()) {
      if (buffers_.empty()) bytes = binary_;
    } else if (!decode_data_uri(uri, bytes)) {
      if (uri.starts_with("data:")) throw std::runtime_error("a buffer in it is not base64");
      const std::string path = decode_path(uri);
      try {
        std::error_code error;
        if (std::filesystem::is_regular_file(folder / path, error) && !readable.resolve(folder / path))
          throw std::runtime_error("it is hidden or outside the folder of the scene");
        bytes = sync::read_regular_file(folder / path, kMaxMeshFileBytes);
      } catch (const std::runtime_error& e) {
        throw std::runtime_error("its buffer \"" + path.substr(0, 200) + "\" cannot be read: " + e.what());
      }
    }
    if (bytes.size() < size_of(buffer, "byteLength")) throw std::runtime_error("a buffer is shorter than its byteLength");
    if (!member_of(buffer, "byteLength").is_null()) bytes.resize(size_of(buffer, "byteLength"));  // no view reaches beyond it
    total += bytes.size();
    if (total > 2 * kMaxMeshFileBytes) throw std::runtime_error("its buffers are too large");
    buffers_.push_back(std::move(bytes));
  }
}

const json& GltfDocument::entry(const char* list, int index) const {
  const json& all = member_of(json_, list);
  if (!all.is_array() || index < 0 || static_cast<std::size_t>(index) >= all.size())
    throw std::runtime_error(std::string("it refers to one of its ") + list + " that does not exist");
  return all[static_cast<std::size_t>(index)];
}

std::span<const std::uint8_t> GltfDocument::view_bytes(const json& view) const {
  const int buffer = index_of(view, "buffer");
  const std::size_t offset = size_of(view, "byteOffset"), length = size_of(view, "byteLength");
  if (buffer < 0 || static_cast<std::size_t>(buffer) >= buffers_.size() ||
      offset + length > buffers_[static_cast<std::size_t>(buffer)].size())
    throw std::runtime_error("a view reaches beyond its buffer");
  return {buffers_[static_cast<std::size_t>(buffer)].data() + offset, length};
}

std::span<const std::uint8_t> GltfDocument::view(int index) const {
  return view_bytes(entry("bufferViews", index));
}

std::size_t GltfDocument::count(int accessor) const { return size_of(entry("accessors", accessor), "count"); }

GltfDocument::Elements GltfDocument::elements(int accessor, int components) const {
  const json& a = entry("accessors", accessor);
  Elements e;
  e.type = index_of(a, "componentType");
  const std::size_t size = bytes_of(e.type) * static_cast<std::size_t>(components);
  if (components_of(text_of(a, "type")) != components)
    throw std::runtime_error("an accessor is not of the type that its use needs");
  e.count = size_of(a, "count");
  if (e.count > kMaxVertices)
    throw std::runtime_error("it has more than " + std::to_string(kMaxVertices) + " vertices or corners");
  const json& normalised = member_of(a, "normalized");
  e.normalised = normalised.is_boolean() && normalised.get<bool>();
  if (member_of(a, "sparse").is_object())
    throw std::runtime_error("it has sparse accessors, which are not supported: export it without");
  const int view = index_of(a, "bufferView");
  if (view < 0 || e.count == 0) return e;
  const json& v = entry("bufferViews", view);
  e.stride = size_of(v, "byteStride");
  if (e.stride == 0) e.stride = size;
  const std::size_t from = size_of(a, "byteOffset");
  const auto bytes = view_bytes(v);
  if (e.stride < size || from + (e.count - 1) * e.stride + size > bytes.size())
    throw std::runtime_error("an accessor reaches beyond its view");
  e.data = bytes.data() + from;
  return e;
}

std::vector<float> GltfDocument::floats(int accessor, int components) const {
  const Elements e = elements(accessor, components);
  std::vector<float> values(e.count * static_cast<std::size_t>(components), 0.0f);
  if (!e.data) return values;
  for (std::size_t i = 0; i < e.count; ++i)
    for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c)
      values[i * static_cast<std::size_t>(components) + c] =
          static_cast<float>(component(e.data + i * e.stride + c * bytes_of(e.type), e.type, e.normalised));
  return values;
}

std::vector<int> GltfDocument::indices(int accessor) const {
  const Elements e = elements(accessor, 1);
  if (e.type != kUnsignedByte && e.type != kUnsignedShort && e.type != kUnsignedInt)
    throw std::runtime_error("its indices are of a type that indices do not have");
  std::vector<int> values(e.count, 0);
  if (!e.data) return values;
  for (std::size_t i = 0; i < e.count; ++i) {
    const double index = component(e.data + i * e.stride, e.type, false);
    if (index > static_cast<double>(kMaxVertices))
      throw std::runtime_error("an index refers to a vertex that does not exist");
    values[i] = static_cast<int>(index);
  }
  return values;
}

}  // namespace tactus::sim
