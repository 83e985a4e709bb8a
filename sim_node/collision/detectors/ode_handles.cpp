#include "sim_node/collision/detectors/ode_handles.h"

#include <cstdarg>

namespace tactus::sim::ode {
namespace {

int users = 0;
long long messages = 0;

void count_message(int, const char*, va_list) { ++messages; }

}  // namespace

Library::Library() {
  if (users++ > 0) return;
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  dSetMessageHandler(count_message);
}

Library::~Library() {
  if (--users == 0) dCloseODE();
}

long long message_count() { return messages; }

}  // namespace tactus::sim::ode
