# Functions shared by the scripts in this folder. They install missing packages (on Debian and Ubuntu) and build the program. This file is sourced, not run.

say() {
    printf '%s\n' "$*" >&2
}

need_rust() {
    if ! command -v cargo >/dev/null 2>&1 && [ -f "$HOME/.cargo/env" ]; then
        . "$HOME/.cargo/env"
    fi
    if ! command -v cargo >/dev/null 2>&1; then
        say "A Rust toolchain is missing. Install it from https://rustup.rs and run this script again."
        exit 1
    fi
}

# need_packages COMMAND:PACKAGE...: installs each package whose command is missing. A COMMAND that contains a '/' is the path of a file.
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

# need_build_packages KIND: installs the packages for a headless build or a build with windows. A headless build requires a C compiler. A build with
# windows also requires a C++ compiler for the video encoder, udev to find gamepads, and ALSA for sound.
need_build_packages() {
    local packages=(cc:gcc objcopy:binutils)
    if [ "$(uname)" = Linux ]; then
        packages+=(/usr/include/stdio.h:libc6-dev)
        if [ "$1" = window ]; then
            packages+=(c++:g++ pkg-config:pkg-config /usr/include/libudev.h:libudev-dev /usr/include/alsa/asoundlib.h:libasound2-dev)
        fi
    fi
    need_packages "${packages[@]}"
}

# build_program KIND: builds the program and copies it without its debug symbols to target/run/KIND. The symbols are in spandrel.debug in the same
# folder, where debuggers and panic backtraces find them.
build_program() {
    local features=()
    if [ "$1" = window ]; then
        features=(--features view,gamepad)
    fi
    cargo build --release --target-dir target --bin spandrel "${features[@]}"
    split_symbols target/release/spandrel "target/run/$1"
}

# split_symbols PROGRAM FOLDER: writes a copy of the program without symbols and a file with its symbols, unless both are up to date.
split_symbols() {
    local program=$1 folder=$2 name
    name=$(basename "$program")
    if [ "$folder/$name" -nt "$program" ]; then
        return
    fi
    mkdir -p "$folder"
    if ! command -v objcopy >/dev/null 2>&1; then
        cp "$program" "$folder/$name.new"
    else
        objcopy --only-keep-debug "$program" "$folder/$name.debug"
        objcopy --strip-all --add-gnu-debuglink="$folder/$name.debug" "$program" "$folder/$name.new"
    fi
    # Renaming, instead of overwriting, keeps running copies of the old program working.
    mv "$folder/$name.new" "$folder/$name"
}

install_packages() {
    say "Missing system packages: $*"
    if ! command -v apt-get >/dev/null 2>&1; then
        say "This is not Debian or Ubuntu. Install the equivalent packages and run this script again."
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
    # Don't upgrade installed packages unless a new package requires a newer version.
    local options=(--no-install-recommends --no-upgrade --no-remove) upgraded
    upgraded=$(apt-get install --simulate "${options[@]}" "$@" | sed -n 's/^Inst \([^ ]*\) \[.*/\1/p' | tr '\n' ' ')
    if [ -n "$upgraded" ]; then
        say "These installed packages must be upgraded: $upgraded"
    fi
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y "${options[@]}" "$@"
}
