// Arbitrary text read as the rules of a relay: rejected with one sentence that names the file, or rules.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "sync/relay/rules.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus::sync;
  const std::string xml(reinterpret_cast<const char*>(data), size);
  try {
    const RelayRules rules = parse_relay_rules(xml, "fuzz.xml");
    if (rules.all().empty()) std::abort();
    for (const PassRule& rule : rules.all())
      if (rules.find(rule.channel) != &rule) std::abort();
  } catch (const std::invalid_argument& e) {
    if (std::string(e.what()).find("fuzz.xml:") != 0) std::abort();
  }
  return 0;
}
