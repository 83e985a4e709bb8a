// Detects the loss of an OpenGL context. A driver that is reset, updated or removed loses all objects of the
// context.
#pragma once

#include <string>

namespace tactus::visual {

// Checks the current context. Returns the reason of its loss as a clause, or an empty string while the driver
// reports no loss.
std::string context_loss_reason();

}  // namespace tactus::visual
