# Compiles for arm64 with the cross compiler of Debian, against the packages of arm64 (NAME:arm64). Programs of the build, and the lcm-gen of
# arm64, run with qemu-user: the packages of LCM cannot be installed for two processors at the same time.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64)
set(LCM_GEN "qemu-aarch64;/usr/bin/lcm-gen" CACHE STRING "The generator of LCM")
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
