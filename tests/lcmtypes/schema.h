// Reads the .lcm files themselves and parses an encoded message by them: an implementation of the wire format
// independent of lcm-gen. It gives the offset of each field, so that tests can corrupt any of them.
//
// Wire format of LCM: an 8-byte fingerprint, then the fields in order, big endian; a string is its length including
// the final zero (int32), then its bytes; a nested struct is its fields.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tactus::test {

struct FieldDef {
  std::string type, name;
  std::string count;        // name of the field with the array's length, or that length; empty: a scalar
  bool enumerated = false;  // constants are listed under it
};
using StructDef = std::vector<FieldDef>;

// The place of one scalar in the bytes.
struct Spot {
  std::string path;  // "contacts[0].normal.x"
  std::string type;  // primitive type, "string" for the length of a string
  std::size_t offset = 0;
  bool is_count = false;
  bool enumerated = false;
};

class Schema {
 public:
  explicit Schema(const std::string& folder) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".lcm") read(entry.path());
  }

  const std::map<std::string, StructDef>& structs() const { return structs_; }

  // Every scalar of the message. Throws std::runtime_error unless the bytes are exactly one message of that type.
  std::vector<Spot> walk(const std::string& type, const std::vector<std::uint8_t>& bytes) const {
    std::vector<Spot> spots;
    std::size_t at = 8;
    walk_struct(type, "", bytes, at, spots);
    if (at != bytes.size())
      throw std::runtime_error(type + ": " + std::to_string(bytes.size() - at) + " bytes left");
    return spots;
  }

 private:
  static std::size_t width(const std::string& type) {
    static const std::map<std::string, std::size_t> widths{{"int8_t", 1},  {"byte", 1},    {"boolean", 1},
                                                           {"int16_t", 2}, {"int32_t", 4}, {"float", 4},
                                                           {"int64_t", 8}, {"double", 8}};
    const auto it = widths.find(type);
    return it == widths.end() ? 0 : it->second;
  }

  void read(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    const std::string plain = std::regex_replace(text.str(), std::regex("//[^\n]*"), "");
    std::smatch body;
    if (!std::regex_search(plain, body, std::regex(R"(struct\s+(\w+)\s*\{([^}]*)\})")))
      throw std::runtime_error(path.string() + ": no struct");
    StructDef fields;
    std::stringstream lines(body[2].str());
    for (std::string line; std::getline(lines, line, ';');) {
      std::smatch m;
      if (std::regex_search(line, std::regex(R"(^\s*const\s)"))) {
        // A constant that is not an integer is a special value of a number, not an enumeration.
        if (!fields.empty() && !std::regex_search(line, std::regex(R"(\bdouble\b)"))) fields.back().enumerated = true;
      } else if (std::regex_search(line, m, std::regex(R"(^\s*(\w+)\s+(\w+)\s*(?:\[(\w+)\])?\s*$)"))) {
        fields.push_back({m[1], m[2], m[3], false});
      } else if (line.find_first_not_of(" \n\t") != std::string::npos) {
        throw std::runtime_error(path.string() + ": cannot read \"" + line + "\"");
      }
    }
    structs_[body[1]] = fields;
  }

  static std::int64_t integer(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t size) {
    if (at + size > bytes.size()) throw std::runtime_error("too short");
    std::uint64_t value = (bytes[at] & 0x80) ? ~std::uint64_t{0} : 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
    return static_cast<std::int64_t>(value);
  }

  void walk_struct(const std::string& type, const std::string& path, const std::vector<std::uint8_t>& bytes,
                   std::size_t& at, std::vector<Spot>& spots) const {
    std::map<std::string, std::int64_t> counts;
    const StructDef& fields = structs_.at(type);
    for (const FieldDef& field : fields) {
      const std::string name = path.empty() ? field.name : path + "." + field.name;
      if (!field.count.empty()) {
        const bool fixed = field.count.find_first_not_of("0123456789") == std::string::npos;
        const std::int64_t count = fixed ? std::stoll(field.count) : counts.at(field.count);
        for (std::int64_t i = 0; i < count; ++i)
          walk_value(field, name + "[" + std::to_string(i) + "]", false, bytes, at, spots);
        continue;
      }
      bool is_count = false;
      for (const FieldDef& other : fields) is_count = is_count || other.count == field.name;
      if (is_count) counts[field.name] = integer(bytes, at, width(field.type));
      walk_value(field, name, is_count, bytes, at, spots);
    }
  }

  void walk_value(const FieldDef& field, const std::string& name, bool is_count,
                  const std::vector<std::uint8_t>& bytes, std::size_t& at, std::vector<Spot>& spots) const {
    if (field.type == "string") {
      spots.push_back({name, "string", at, false, false});
      at += 4 + static_cast<std::size_t>(integer(bytes, at, 4));
    } else if (const std::size_t size = width(field.type)) {
      spots.push_back({name, field.type, at, is_count, field.enumerated});
      at += size;
    } else {
      walk_struct(field.type, name, bytes, at, spots);
    }
    if (at > bytes.size()) throw std::runtime_error(name + " ends after the message");
  }

  std::map<std::string, StructDef> structs_;
};

// Overwrites a big-endian number.
template <class Number>
void put(std::vector<std::uint8_t>& bytes, std::size_t at, Number value) {
  unsigned char raw[sizeof value];
  __builtin_memcpy(raw, &value, sizeof value);
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.at(at + i) = raw[sizeof value - 1 - i];
}

}  // namespace tactus::test
