// message_types: prints the messages of this build: its version, the channels, and the fields and fingerprint of every type.
// Builds with the same output can communicate.
#include <iostream>

#include "sync/node/node_options.h"
#include "sync/log/recorder_types.h"

using namespace tactus;

int main(int argc, char** argv) try {
  sync::Arguments app{
      "Prints the message types of this build: version, channels, fields and fingerprints, as in every log."};
  sync::parse_or_exit(app, "message_types", argc, argv);
  std::cout << "version " << TACTUS_VERSION << "\n";
  for (const std::string& page : sync::log_types()) std::cout << page.substr(page.find('\n') + 1);
  return std::cout.flush() ? 0 : 1;
} catch (const std::exception& e) {
  return tactus::sync::fail("message_types", e);
}
