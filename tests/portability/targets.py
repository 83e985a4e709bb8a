"""The targets of tests/portability/run: a release of Debian, or another processor in a release of Debian."""
import dataclasses

# Steps on the processor of this machine: name, command in the checkout. A later step runs also when a step of tests fails.
FULL = {
    "packages": "scripts/setup --packages test",
    "build": "scripts/build",
    "unit": "scripts/test --label unit",
    "run": "scripts/run --seconds 5 --out /tmp/run",
    "all": "scripts/test",
}
# The folders that run on another processor: their libraries, haptic_node, and their tests.
ARM64_TESTS = ("lcmtypes_test", "sync_test", "haptic_node_test", "haptic_offline_test")
ARM64_PACKAGES = ("g++", "g++-aarch64-linux-gnu", "qemu-user", "cmake", "ninja-build", "pkg-config", "python3-minimal", "ccache",  # of this machine
                  "libeigen3-dev", "libcli11-dev", "nlohmann-json3-dev",  # of every processor
                  "catch2:arm64", "liblcm-dev:arm64", "liblcm-bin:arm64", "libseccomp-dev:arm64", "libtinyxml2-dev:arm64", "libboost-dev:arm64",
                  "libboost-context-dev:arm64", "libpng-dev:arm64", "libjpeg-dev:arm64")
ARM64 = {
    "packages": "dpkg --add-architecture arm64 && apt-get update -qq && apt-get install -y -qq --no-install-recommends " + " ".join(ARM64_PACKAGES),
    "build": "cmake --preset arm64 && ninja -C build/arm64 haptic_node " + " ".join(ARM64_TESTS),
    # As the tests would run on a computer with that processor, but for two kinds: qemu-user starts no other program of arm64 and has no
    # system call filter, so tests that need a confined reader fail. They are named.
    "unit": "ctest --test-dir build/arm64 --output-on-failure --no-tests=error -L unit -R '^(lcmtypes|sync|haptic_node): '",
}


@dataclasses.dataclass(frozen=True)
class Target:
    release: str  # of Debian
    title: str
    steps: dict


TARGETS = {"bookworm": Target("bookworm", "Debian 12", FULL), "trixie": Target("trixie", "Debian 13", FULL),
           "arm64": Target("bookworm", "Debian 12, arm64 by cross compiler and qemu-user", ARM64)}


def steps_until(target, last):
    """The names of the steps up to `last`; those of tests before it are left out, but for "all". Raises KeyError when the target has no such step."""
    names = list(target.steps)
    if last is None or last == names[-1]:
        return names
    until = names[:names.index(last) + 1] if last in names else None
    if until is None:
        raise KeyError(last)
    return [name for name in until if name == last or name in ("packages", "build")]
