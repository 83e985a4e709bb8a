// A glTF 2.0 document (Khronos 2021): its JSON, buffers and accessors. All content is validated.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "sync/assets/asset.h"
#include "sync/sandbox/readable_folders.h"

namespace tactus::sim {

class GltfDocument {
 public:
  // Detects .gltf or .glb by the content. readable: folders of its buffers. Throws std::runtime_error with one clause.
  GltfDocument(const std::filesystem::path& file, const sync::ReadableFolders& readable);

  const nlohmann::json& root() const { return json_; }
  // An entry of a list of the document ("nodes", "meshes", ...).
  const nlohmann::json& entry(const char* list, int index) const;

  // The number of elements of an accessor, before they are read.
  std::size_t count(int accessor) const;
  // `components` numbers per element, scaled as the accessor defines.
  std::vector<float> floats(int accessor, int components) const;
  std::vector<int> indices(int accessor) const;
  // The bytes of a buffer view.
  std::span<const std::uint8_t> view(int index) const;

 private:
  struct Elements;
  Elements elements(int accessor, int components) const;
  std::span<const std::uint8_t> view_bytes(const nlohmann::json& view) const;
  void load_buffers(const std::filesystem::path& folder, const sync::ReadableFolders& readable);

  nlohmann::json json_;
  sync::Bytes binary_;  // of a .glb
  std::vector<sync::Bytes> buffers_;
};

// The number of a member, or `missing` when it does not exist or is not a number.
double number_of(const nlohmann::json& object, const char* member, double missing);
int as_index(const nlohmann::json& value);  // -1: not an index
// -1: the member does not exist. Throws std::runtime_error with one clause when it is no index.
int index_of(const nlohmann::json& object, const char* member);
std::string text_of(const nlohmann::json& object, const char* member);
const nlohmann::json& member_of(const nlohmann::json& object, const char* member);  // null: none

// Decodes "data:...;base64,..."; false: not such a URI.
bool decode_data_uri(const std::string& uri, sync::Bytes& bytes);
std::string encode_base64(const sync::Bytes& bytes);
// Percent encoding of paths (RFC 3986), and its inverse.
std::string decode_path(const std::string& uri);
std::string encode_path(const std::string& path);

}  // namespace tactus::sim
