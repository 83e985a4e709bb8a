// The elements of a scene as one tree: includes are replaced by the models that they name, and elements of older versions
// of SDFormat by those of 1.9.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "sim_node/scene/sdf/element.h"
#include "sim_node/scene/sdf/sdf_files.h"

namespace tactus::sim::sdf {

class Tree {
 public:
  // Throws std::runtime_error with file and line. The files must outlive the tree.
  Tree(const SdfFiles& files, std::vector<std::string>& warnings);
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;

  // <sdf>
  const Element& root() const { return *root_; }

 private:
  Element& append(Element& parent, std::string_view name, const Source& source, int line);
  // foreign: inside an element for another program.
  Element& copy(const tinyxml2::XMLElement& xml, const Source& source, Element* parent, bool foreign = false);

  // include.cpp
  void include(const tinyxml2::XMLElement& xml, const Source& source, Element& parent);
  void override_model(const tinyxml2::XMLElement& include, const Source& source, Element& model);
  void merge(Element& model, Element& parent);
  void merge_world(const tinyxml2::XMLElement& world, const Source& source, Element& parent);
  Element& frame_of_merged(Element& model, Element& parent);

  const SdfFiles& files_;
  std::vector<std::string>& warnings_;
  std::deque<Element> elements_;
  std::deque<std::string> strings_;  // those that are in no file
  Element* root_ = nullptr;
};

// Moves `child` to the end of the children of `parent`. It has no parent yet.
void adopt(Element& parent, Element& child);
// Removes `child` from the children of its parent.
void remove(Element& child);
void set_attribute(Element& element, std::string_view key, std::string_view value);

}  // namespace tactus::sim::sdf
