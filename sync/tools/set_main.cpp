// set: changes settings of a node of the running cluster, and prints the results.
#include <iostream>
#include <stdexcept>
#include <tactus/setting_change_t.hpp>
#include <tactus/setting_reply_t.hpp>

#include "sync/bus/request_reply.h"
#include "sync/bus/bus_arguments.h"
#include "sync/bus/bus.h"
#include "sync/node/node_options.h"
#include "sync/node/setting_changes.h"
#include "sync/text/printable.h"

using namespace tactus;

namespace {

constexpr sync::Nanoseconds kTimeout{3'000'000'000};  // every node handles requests once a tick

std::pair<std::string, std::string> setting_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw std::invalid_argument("\"" + sync::printable(text) +
                                "\" is not NAME=VALUE; write for example rendering=direct");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// One request, so that the node changes all of the settings or none.
setting_change_t change_of(const std::string& node, const std::vector<std::string>& words) {
  sync::SettingList settings;
  for (const std::string& word : words) settings.push_back(setting_of(word));
  setting_change_t c{};
  c.header.sim_time_ns = -1;
  c.header.run_id = c.header.incarnation = 1;  // the bus stamps them; a header without is not valid
  c.id = sync::request_id();
  c.node = node;
  sync::pack_settings(c, settings);
  if (!valid(c)) throw std::invalid_argument("a name or a value is too long or has unprintable characters");
  return c;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app("Changes settings of a node of the running cluster, and prints the result.");
  sync::BusOptions bus_options;
  std::int64_t run_id = 1;
  std::string node;
  std::vector<std::string> words;
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "number of the cluster run").environment("TACTUS_RUN_ID").show_default();
  app.add_option("NODE", node, "name in its health: haptic_node, or its --name").required();
  // CLI11 2.4 refuses a name with an equals sign.
  app.add_option("SETTING", words, "NAME=VALUE, as in a scene; docs/settings.md lists the settings that can change").required();
  sync::parse_or_exit(app, "set", argc, argv);
  setting_change_t change = change_of(node, words);

  sync::Bus bus(sync::Identity::fresh("set", run_id), bus_options);
  auto& replies = bus.queue<setting_reply_t>(channels::kSettingReply, 64);
  const auto reply = sync::request(bus, channels::kSetting, change, replies, kTimeout);
  if (!reply)
    throw std::runtime_error("no \"" + sync::printable(node) +
                             "\" with live settings answers; docs/settings.md lists the live settings, "
                             "tactus attach watch lists the nodes");
  if (!reply->done)
    throw std::runtime_error(sync::printable(reply->text) + (words.size() > 1 ? "; no setting was changed" : ""));
  std::cout << sync::printable(reply->text) << std::endl;
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("set", e);
}
