// Elements of a scene after its includes have been replaced by their content: name, attributes, text, file and line of
// each. The text belongs to the parsed files (SdfFiles), which outlive the elements.
#pragma once

#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::sim::sdf {

// A file of the scene.
struct Source {
  std::filesystem::path file;
  std::string shown;  // as the user named it
  int version = 0;    // minor version of its SDFormat: 9 for 1.9; 0: none
};

// Without blanks around the value.
struct Attribute {
  std::string_view name, value;
};

class Children;

struct Element {
  std::string_view name;  // "model", "tactus:tool"
  std::string_view text;  // of the element itself, without blanks around it
  std::vector<Attribute> attributes;
  const Source* source = nullptr;
  int line = 0;  // 0: none
  Element *parent = nullptr, *first = nullptr, *last = nullptr, *next = nullptr;

  // nullptr: there is none.
  const Attribute* attribute(std::string_view key) const;
  // The value of an attribute, or `missing`.
  std::string_view value(std::string_view key, std::string_view missing = {}) const;
  // The first child of that name; nullptr: there is none.
  const Element* child(std::string_view child_name) const;
  // All children, or those of one name, in the order of the file.
  Children children(std::string_view child_name = {}) const;
};

class Children {
 public:
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Element;
    using difference_type = std::ptrdiff_t;
    using pointer = const Element*;
    using reference = const Element&;

    Iterator(const Element* at, std::string_view name) : at_(at), name_(name) { skip(); }
    reference operator*() const { return *at_; }
    pointer operator->() const { return at_; }
    Iterator& operator++() {
      at_ = at_->next;
      skip();
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    void skip() {
      while (at_ && !name_.empty() && at_->name != name_) at_ = at_->next;
    }
    const Element* at_;
    std::string_view name_;
  };

  Children(const Element* first, std::string_view name) : first_(first), name_(name) {}
  Iterator begin() const { return {first_, name_}; }
  Iterator end() const { return {nullptr, name_}; }

 private:
  const Element* first_;
  std::string_view name_;
};

// The first child of that name; nullptr also for an element that is nullptr.
const Element* child_of(const Element* element, std::string_view child_name);

// "FILE:LINE", with the file as the user named it.
std::string where(const Source& source, int line);
std::string where(const Element& element);
// "/sdf/world[@name="w"]/model[@name="m"]": through the elements that include it.
std::string path_of(const Element& element);
// Names and values of a file may hold line breaks, and sequences that move the cursor of a terminal: blanks instead. At most
// 1,500 bytes.
std::string one_line(std::string text);
// "FILE:LINE: PATH sentence", in one line.
std::string message(const Element& element, const std::string& sentence);
// Adds a warning; beyond a thousand, one sentence says that there are more.
void add_warning(std::vector<std::string>& warnings, const std::string& text);
// Throws std::runtime_error with that message.
[[noreturn]] void reject(const Element& element, const std::string& sentence);

// The content of such an element is for other programs, or has no effect here: it is not checked, and nothing in it is
// included. A <plugin>, <actor>, <state> or <population>, and all with a prefix as in "tactus:tool".
bool is_foreign(std::string_view element_name);

// Without blanks around it.
std::string_view trimmed(std::string_view text);

}  // namespace tactus::sim::sdf
