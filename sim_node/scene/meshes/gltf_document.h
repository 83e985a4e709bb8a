// A glTF 2.0 document (Khronos 2021): its JSON, its buffers, and what its accessors say. Nothing in it is believed
// unchecked.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sync/assets/scene_exchange.h"

namespace tactus::sim {

class GltfDocument {
 public:
  // .gltf or .glb by its content. Throws std::runtime_error with one clause.
  explicit GltfDocument(const std::filesystem::path& file);

  const nlohmann::json& root() const { return json_; }
  // The entry of a list of the document ("nodes", "meshes", ...).
  const nlohmann::json& entry(const char* list, int index) const;

  // `components` numbers for each element, as the accessor scales them.
  std::vector<float> floats(int accessor, int components) const;
  std::vector<int> indices(int accessor) const;
  // The bytes of a buffer view.
  sync::Bytes view(int index) const;

 private:
  struct Elements;
  Elements elements(int accessor, int components) const;
  void load_buffers(const std::filesystem::path& folder);

  nlohmann::json json_;
  sync::Bytes binary_;  // of a .glb
  std::vector<sync::Bytes> buffers_;
};

// The number of a member, or what is said for one that is not there or no number.
double number_of(const nlohmann::json& object, const char* member, double missing);
int as_index(const nlohmann::json& value);                       // -1: it is none
int index_of(const nlohmann::json& object, const char* member);  // -1: none
std::string text_of(const nlohmann::json& object, const char* member);
const nlohmann::json& member_of(const nlohmann::json& object, const char* member);  // null: none

// What "data:...;base64,..." holds; false: it is no such uri.
bool decode_data_uri(const std::string& uri, sync::Bytes& bytes);
std::string encode_base64(const sync::Bytes& bytes);
// Paths as uris have them (RFC 3986), and back.
std::string decode_path(const std::string& uri);
std::string encode_path(const std::string& path);

}  // namespace tactus::sim
