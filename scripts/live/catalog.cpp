#include "scripts/live/catalog.h"

#include <nlohmann/json.hpp>

#include "lcmtypes/fields.h"

namespace tactus::live {
namespace {

constexpr int kMaxDepth = 4;  // design: deeper members are not worth plotting

void add(const MessageType& type, const std::string& before, int depth, nlohmann::json& out, const std::string& channel) {
  for (const Field& field : type.fields) {
    if (depth == 0 && field.name == "header") continue;
    if (field.type == "byte") continue;
    const std::string path = before + std::string(field.name) + (field.count.empty() ? "" : "[0]");
    if (const MessageType* inner = message_type(field.type)) {
      if (depth + 1 < kMaxDepth) add(*inner, path + ".", depth + 1, out, channel);
      continue;
    }
    if (field.type == "string") continue;
    out.push_back({{"name", channel + ":" + path}, {"unit", FieldPath(*type_on(channel), path).unit()},
                   {"about", std::string(field.comment)}});
  }
}

}  // namespace

nlohmann::json field_catalog() {
  nlohmann::json out = nlohmann::json::array();
  for (const Channel& channel : channel_types()) {
    const MessageType* type = type_on(channel.name);
    if (type == nullptr || channel.name == "PICTURE_CHUNK" || channel.name == "ASSET_CHUNK") continue;
    add(*type, "", 0, out, std::string(channel.name));
  }
  return out;
}

}  // namespace tactus::live
