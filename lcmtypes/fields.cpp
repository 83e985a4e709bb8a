#include "lcmtypes/fields.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <stdexcept>

#include "lcmtypes/spelling_suggestions.h"

namespace tactus {
namespace {

// Bytes of a number on the wire; 0: text or a struct.
std::size_t width(std::string_view type) {
  if (type == "int8_t" || type == "byte" || type == "boolean") return 1;
  if (type == "int16_t") return 2;
  if (type == "int32_t" || type == "float") return 4;
  if (type == "int64_t" || type == "double") return 8;
  return 0;
}

std::optional<std::int64_t> whole(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Reads forward through the bytes; at a premature end it stops and reports failure.
class Walk {
 public:
  explicit Walk(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool good() const { return good_; }
  void fail() { good_ = false; }
  std::size_t left() const { return bytes_.size() - at_; }
  void skip(std::size_t bytes) {
    if (bytes > left()) return fail();
    at_ += bytes;
  }
  // Big endian.
  std::uint64_t take(std::size_t bytes) {
    if (!good_ || bytes > left()) return fail(), 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | bytes_[at_++];
    return value;
  }
  std::int64_t take_whole(std::size_t bytes) {
    const auto shift = static_cast<int>(64 - 8 * bytes);
    return static_cast<std::int64_t>(take(bytes) << shift) >> shift;
  }
  double number(std::string_view type) {
    if (type == "float") return std::bit_cast<float>(static_cast<std::uint32_t>(take(4)));
    if (type == "double") return std::bit_cast<double>(take(8));
    return static_cast<double>(take_whole(width(type)));
  }
  // The length, including the final zero, comes first.
  std::string text(bool wanted) {
    const std::int64_t size = take_whole(4);
    if (!good_ || size < 1 || static_cast<std::size_t>(size) > left()) return fail(), "";
    std::string found;
    if (wanted)
      found.assign(reinterpret_cast<const char*>(bytes_.data()) + at_, static_cast<std::size_t>(size - 1));
    skip(static_cast<std::size_t>(size));
    return found;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

using Counts = std::map<std::string_view, std::int64_t>;

// Number of elements. Each has at least one byte on the wire, so a length above the remaining bytes is invalid.
std::int64_t length(const Field& field, const Counts& counts, Walk& walk) {
  if (field.count.empty()) return 1;
  const auto fixed = whole(field.count);
  const auto found = counts.find(field.count);
  const std::int64_t n = fixed ? *fixed : found == counts.end() ? -1 : found->second;
  if (n < 0 || static_cast<std::uint64_t>(n) > walk.left()) return walk.fail(), 0;
  return n;
}

void skip_fields(const MessageType& type, std::size_t end, Walk& walk, Counts& counts);

void skip_one(const Field& field, Walk& walk) {
  if (field.type == "string") {
    walk.text(false);
  } else if (const std::size_t bytes = width(field.type)) {
    walk.skip(bytes);
  } else {
    Counts counts;
    const MessageType& type = *message_type(field.type);
    skip_fields(type, type.fields.size(), walk, counts);
  }
}

void skip_fields(const MessageType& type, std::size_t end, Walk& walk, Counts& counts) {
  for (std::size_t i = 0; i < end && walk.good(); ++i) {
    const Field& field = type.fields[i];
    const std::size_t bytes = width(field.type);
    if (field.count.empty() && bytes > 0 && field.type != "float" && field.type != "double") {
      counts[field.name] = walk.take_whole(bytes);
      continue;
    }
    const std::int64_t n = length(field, counts, walk);
    if (bytes > 0)
      walk.skip(bytes * static_cast<std::size_t>(n));
    else
      for (std::int64_t k = 0; k < n && walk.good(); ++k) skip_one(field, walk);
  }
}

struct Visit {
  Walk& walk;
  const std::function<void(const std::string&, const Field&, const Leaf&)>& leaf;

  // prefix: including its final dot.
  void fields(const MessageType& type, const std::string& prefix) {
    Counts counts;
    for (const Field& field : type.fields) {
      const std::int64_t n = length(field, counts, walk);
      for (std::int64_t i = 0; i < n && walk.good(); ++i) {
        const std::string path =
            prefix + std::string(field.name) + (field.count.empty() ? "" : "[" + std::to_string(i) + "]");
        one(field, path, counts);
      }
      if (!walk.good()) return;
    }
  }
  void one(const Field& field, const std::string& path, Counts& counts) {
    const std::size_t bytes = width(field.type);
    if (field.type == "string") {
      const std::string text = walk.text(true);
      if (walk.good()) leaf(path, field, text);
    } else if (field.type == "float" || field.type == "double") {
      const double value = walk.number(field.type);
      if (walk.good()) leaf(path, field, value);
    } else if (bytes > 0) {
      const std::int64_t value = walk.take_whole(bytes);
      if (!walk.good()) return;
      if (field.count.empty()) counts[field.name] = value;
      leaf(path, field, value);
    } else {
      fields(*message_type(field.type), path + ".");
    }
  }
};

[[noreturn]] void unknown(const MessageType& type, std::string_view name) {
  std::vector<std::string> names;
  for (const Field& f : type.fields) names.emplace_back(f.name);
  throw std::invalid_argument(std::string(type.name) + " has no field \"" + std::string(name.substr(0, 64)) +
                              "\"; nearest: " + spelling_suggestions(name, names));
}

}  // namespace

const MessageType* message_type(std::string_view name) {
  const auto all = message_types();
  const auto it = std::find_if(all.begin(), all.end(), [&](const MessageType& t) { return t.name == name; });
  return it == all.end() ? nullptr : &*it;
}

const MessageType* message_type(std::int64_t fingerprint) {
  const auto all = message_types();
  const auto it =
      std::find_if(all.begin(), all.end(), [&](const MessageType& t) { return t.fingerprint == fingerprint; });
  return it == all.end() ? nullptr : &*it;
}

const MessageType* type_of(std::span<const std::uint8_t> bytes) {
  return bytes.size() < 8 ? nullptr : message_type(Walk(bytes).take_whole(8));
}

const MessageType* type_on(std::string_view channel) {
  for (const Channel& c : channel_types())
    if (c.name == channel) return message_type(c.type);
  return nullptr;
}

bool for_each_leaf(const MessageType& type, std::span<const std::uint8_t> bytes,
                   const std::function<void(const std::string&, const Field&, const Leaf&)>& visit) {
  Walk walk(bytes);
  if (walk.take_whole(8) != type.fingerprint) return false;
  Visit{walk, visit}.fields(type, "");
  return walk.good() && walk.left() == 0;
}

FieldPath::FieldPath(const MessageType& type, std::string_view path) : type_(&type), path_(path) {
  const MessageType* in = &type;
  while (!path.empty()) {
    const std::size_t dot = path.find('.');
    std::string_view name = path.substr(0, dot);
    path = dot == std::string_view::npos ? std::string_view{} : path.substr(dot + 1);
    if (!in)
      throw std::invalid_argument("\"" + path_.substr(0, 64) + "\": " + std::string(last_->name) +
                                  " has no fields");
    std::optional<std::int64_t> index;
    if (const std::size_t bracket = name.find('['); bracket != std::string_view::npos) {
      if (name.back() == ']') index = whole(name.substr(bracket + 1, name.size() - bracket - 2));
      if (!index || *index < 0)
        throw std::invalid_argument("\"" + std::string(name.substr(0, 64)) +
                                    "\": write the place in the list as a number, [0] is the first");
      name = name.substr(0, bracket);
    }
    const auto it =
        std::find_if(in->fields.begin(), in->fields.end(), [&](const Field& f) { return f.name == name; });
    if (it == in->fields.end()) unknown(*in, name);
    if (it->count.empty() == index.has_value())
      throw std::invalid_argument(std::string(it->name) +
                                  (index ? " is not a list; leave out []" : " is a list; give the index, as in ") +
                                  (index ? "" : std::string(it->name) + "[0]"));
    last_ = &*it;
    steps_.push_back({static_cast<std::size_t>(it - in->fields.begin()), index.value_or(0)});
    in = message_type(it->type);
  }
  if (!last_)
    throw std::invalid_argument("which field of " + std::string(type.name) + "? Give the name of a field");
  if (in) {
    std::string names;
    for (const Field& f : in->fields) names += (names.empty() ? "" : ", ") + std::string(f.name);
    throw std::invalid_argument(std::string(last_->name) + " is not a number; it has " + names);
  }
}

std::optional<std::variant<double, std::string>> FieldPath::read(std::span<const std::uint8_t> bytes) const {
  Walk walk(bytes);
  if (walk.take_whole(8) != type_->fingerprint) return std::nullopt;
  const MessageType* in = type_;
  for (const Step& step : steps_) {
    Counts counts;
    const Field& field = in->fields[step.field];
    skip_fields(*in, step.field, walk, counts);
    if (!walk.good() || step.index >= length(field, counts, walk) || !walk.good()) return std::nullopt;
    for (std::int64_t i = 0; i < step.index && walk.good(); ++i) skip_one(field, walk);
    in = message_type(field.type);
  }
  std::variant<double, std::string> value;
  if (is_text())
    value = walk.text(true);
  else
    value = walk.number(last_->type);
  if (!walk.good()) return std::nullopt;
  return value;
}

std::optional<double> FieldPath::number(std::span<const std::uint8_t> bytes) const {
  const auto value = read(bytes);
  if (!value || is_text()) return std::nullopt;
  return std::get<double>(*value);
}

std::string unit_of(std::string_view name) {
  // Longest first: m_s is not s.
  static constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"_J_kgK", "J/kgK"}, {"_kg_m3", "kg/m3"}, {"_N_s_m", "N s/m"}, {"_W_m2", "W/m2"}, {"_rad_s", "rad/s"},
      {"_m_s2", "m/s2"},   {"_W_mK", "W/mK"},   {"_N_s", "N s"},     {"_N_m", "N m"},   {"_m_s", "m/s"},
      {"_1_m", "1/m"},     {"_degC", "degC"},   {"_rad", "rad"},     {"_kg", "kg"},     {"_Hz", "Hz"},
      {"_Pa", "Pa"},       {"_m2", "m2"},       {"_ns", "ns"},       {"_N", "N"},       {"_J", "J"},
      {"_K", "K"},         {"_W", "W"},         {"_A", "A"},         {"_V", "V"},       {"_m", "m"},
      {"_s", "s"}};
  // A stiffness is in N/m, a torque in N m.
  if (name.starts_with("stiffness") && name.ends_with("_N_m")) return "N/m";
  for (const auto& [suffix, unit] : kUnits)
    if (name.ends_with(suffix)) return std::string(unit);
  return "";
}

std::string FieldPath::unit() const { return unit_of_path(path_); }

std::string unit_of_path(std::string_view path) {
  std::string rest(path);
  while (!rest.empty()) {
    const std::size_t dot = rest.rfind('.');
    std::string name = dot == std::string::npos ? rest : rest.substr(dot + 1);
    if (std::string unit = unit_of(name.substr(0, name.find('['))); !unit.empty()) return unit;
    rest.resize(dot == std::string::npos ? 0 : dot);
  }
  return "";
}

}  // namespace tactus
