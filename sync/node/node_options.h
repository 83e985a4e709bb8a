// The command-line options of a node, and the two ends of its main function.
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "sync/bus/bus_options.h"
#include "sync/degradation/profile.h"
#include "sync/text/arguments.h"

namespace tactus::sync {

struct NodeDescriptor;

// The options that every node has. Add them to the program's arguments with add_to, add the node's own, then parse.
struct NodeOptions {
  BusOptions bus;
  std::int64_t run_id = 1;
  std::string name;  // process name; default: the descriptor's
  std::string realtime = "try";
  std::string out = ".";  // folder for the files that the node writes
  std::uint64_t seed = 1;
  std::vector<std::string> set;  // name=value
  std::string degrade;           // file of a degradation profile; empty: none
  ProfileInForce profile;        // the parsed content of that file
  double load = 0;               // for measurements: this share of its period is spent in an idle loop
  bool check = false;            // exit with success before joining the bus

  void add_to(Arguments& app, const NodeDescriptor& descriptor);
};

// Parses. Prints help or one error sentence and exits where the process must not start.
void parse_or_exit(Arguments& app, const std::string& node, int argc, char** argv);

// For `int main() try { ... } catch (const std::exception& e) { return sync::fail("audio_node", e); }`: prints one
// sentence to stderr and returns 1.
int fail(const std::string& node, const std::exception& e);

}  // namespace tactus::sync
