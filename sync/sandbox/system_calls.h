// The system calls of a process that parses a file, by libseccomp.
#pragma once

namespace tactus::sync {

// Installs a seccomp filter for the calling thread: it may read files, manage its memory, write to open descriptors and
// end; every other system call fails with EPERM. Needs no_new_privs. Irreversible. Returns false when the kernel or the
// architecture has no such filter. threads: it may also start threads, which inherit the filter.
bool restrict_system_calls(bool threads);

// Whether this kernel has such filters, and allows this process to install them. Changes nothing.
bool has_system_call_filter();

}  // namespace tactus::sync
