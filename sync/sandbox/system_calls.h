// The system calls of a process that parses a file.
#pragma once

namespace tactus::sync {

// Installs a seccomp filter for the calling thread: it may read files, manage its memory, write to open descriptors and
// end; every other system call fails with EPERM. Needs no_new_privs. Irreversible. Returns false when the kernel or the
// architecture has no such filter.
bool restrict_system_calls();

}  // namespace tactus::sync
