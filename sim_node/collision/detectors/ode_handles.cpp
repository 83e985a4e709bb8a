#include "sim_node/collision/detectors/ode_handles.h"

#include <cstdarg>

namespace tactus::sim::ode {
namespace {

int users = 0;

// ODE's LCP solver prints a message when it fails on a redundant contact.
void ignore_message(int, const char*, va_list) {}

}  // namespace

Library::Library() {
  if (users++ > 0) return;
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  dSetMessageHandler(ignore_message);
}

Library::~Library() {
  if (--users == 0) dCloseODE();
}

}  // namespace tactus::sim::ode
