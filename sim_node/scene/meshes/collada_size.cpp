#include "sim_node/scene/meshes/collada_size.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "sim_node/scene/meshes/mesh_parts.h"
#include "sim_node/scene/meshes/mesh_reader.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

using Element = tinyxml2::XMLElement;

constexpr int kMaxDepth = 100;                // assimp's functions call themselves for each level
constexpr std::size_t kSearchedBytes = 4096;  // the root element stands at the beginning

[[noreturn]] void reject(const Element& at, const std::string& what) {
  throw std::runtime_error("line " + std::to_string(at.GetLineNum()) + ": " + what);
}

// Assimp selects its reader by the ending, and else by the content.
bool is_collada(const std::filesystem::path& file, std::string_view text) {
  const auto lower = [](std::string words) {
    std::transform(words.begin(), words.end(), words.begin(), [](unsigned char c) { return std::tolower(c); });
    return words;
  };
  return lower(file.extension().string()) == ".dae" ||
         lower(std::string(text.substr(0, kSearchedBytes))).find("<collada") != std::string::npos;
}

class Expansion {
 public:
  explicit Expansion(const Element& root) {
    std::vector<const Element*> pending{&root};
    while (!pending.empty()) {
      const Element* element = pending.back();
      pending.pop_back();
      const std::string_view name = element->Value();
      if (name == "node")
        for (const char* key : {"id", "name"})
          if (const char* value = element->Attribute(key)) nodes_[value].push_back(element);
      if (name == "visual_scene") scenes_.push_back(element);
      for (const auto* child = element->FirstChildElement(); child; child = child->NextSiblingElement())
        pending.push_back(child);
    }
  }

  void check() {
    for (const Element* scene : scenes_) size_of(*scene, 0);
  }

 private:
  struct Size {
    std::size_t nodes = 0;  // 0: not complete, so a node that contains itself meets it
    int height = 0;
  };

  Size size_of(const Element& node, int depth) {
    if (depth > kMaxDepth) reject(node, "its nodes are nested deeper than " + std::to_string(kMaxDepth) + " levels");
    const auto [at, is_new] = sizes_.try_emplace(&node);
    if (!is_new && at->second.nodes == 0) reject(node, "this node contains itself");
    if (!is_new) return at->second;
    Size size{1, 1};
    const auto add = [&](const Element& at, const Size& more) {
      size.nodes += more.nodes;
      size.height = std::max(size.height, more.height + 1);
      if (size.nodes > kMaxMeshParts)
        reject(at, "its nodes expand to more than " + std::to_string(kMaxMeshParts) + ": simplify it");
      if (size.height > kMaxDepth)
        reject(at, "its nodes are nested deeper than " + std::to_string(kMaxDepth) + " levels");
    };
    for (const auto* child = node.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string_view name = child->Value();
      if (name == "node") add(*child, size_of(*child, depth + 1));
      if (name == "instance_node") add(*child, largest(*child, depth + 1));
      if (name == "instance_geometry" || name == "instance_controller") add(*child, {1, 0});
    }
    return at->second = size;
  }

  // Of all nodes with the id or name: which one assimp uses does not matter then.
  Size largest(const Element& instance, int depth) {
    Size size;
    std::string_view url = instance.Attribute("url") ? instance.Attribute("url") : "";
    if (url.starts_with('#')) url.remove_prefix(1);
    const auto known = nodes_.find(std::string(url));
    if (known == nodes_.end()) return size;
    for (const Element* node : known->second) {
      const Size each = size_of(*node, depth);
      size = {std::max(size.nodes, each.nodes), std::max(size.height, each.height)};
    }
    return size;
  }

  std::map<std::string, std::vector<const Element*>> nodes_;  // by id and by name
  std::vector<const Element*> scenes_;
  std::map<const Element*, Size> sizes_;
};

}  // namespace

void check_collada(const std::filesystem::path& file) {
  const std::string text = sync::read_regular_text(file, kMaxMeshFileBytes);
  if (!is_collada(file, text)) return;
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || !document.RootElement())
    throw std::runtime_error("line " + std::to_string(document.ErrorLineNum()) + ": it is not well-formed XML, or nested too deeply");
  Expansion(*document.RootElement()).check();
}

}  // namespace tactus::sim
