# Shared by tools/run and tools/test: finds what is missing and, on Debian and Ubuntu, installs it. Sourced, not run.

say() {
    printf '%s\n' "$*" >&2
}

need_rust() {
    if ! command -v cargo >/dev/null 2>&1 && [ -f "$HOME/.cargo/env" ]; then
        . "$HOME/.cargo/env"
    fi
    if ! command -v cargo >/dev/null 2>&1; then
        say "A Rust toolchain is missing: install it from https://rustup.rs and run this again."
        exit 1
    fi
}

# need_packages COMMAND:PACKAGE...: installs the packages whose command is not there. A COMMAND with a '/' is a file.
need_packages() {
    local pair command missing=()
    for pair in "$@"; do
        command=${pair%%:*}
        case $command in
            */*) [ -e "$command" ] || missing+=("${pair#*:}") ;;
            *) command -v "$command" >/dev/null 2>&1 || missing+=("${pair#*:}") ;;
        esac
    done
    if [ ${#missing[@]} -gt 0 ]; then
        install_packages "${missing[@]}"
    fi
}

# What gamepads and transmitters need to build: Linux tells of them through udev.
need_gamepad_packages() {
    if [ "$(uname)" = Linux ]; then
        need_packages pkg-config:pkg-config /usr/include/libudev.h:libudev-dev
    fi
}

install_packages() {
    say "Missing system packages: $*"
    if ! command -v apt-get >/dev/null 2>&1; then
        say "This is no Debian or Ubuntu: install what corresponds to them (a C compiler and linker, Python 3 with venv, pkg-config, libudev's headers) and run this again."
        exit 1
    fi
    local root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null 2>&1; then
            say "Install them as root: apt-get install $*"
            exit 1
        fi
        root=(sudo)
        if [ -t 0 ]; then
            local answer
            read -r -p "Install them now with sudo apt-get? [y/N] " answer
            case $answer in
                y | Y | yes) ;;
                *) say "Nothing was installed."; exit 1 ;;
            esac
        fi
    fi
    say "Installing: $*"
    "${root[@]}" apt-get update
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}
