# Shared by the scripts beside it: finds what is missing and, on Debian and Ubuntu, installs it; builds the program. Sourced, not run.

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

# need_build_packages KIND: what a headless build or one with windows needs. Headless: a C compiler. Windows: the video encoder is C++, and
# gamepads are found through udev.
need_build_packages() {
    local packages=(cc:gcc objcopy:binutils)
    if [ "$(uname)" = Linux ]; then
        packages+=(/usr/include/stdio.h:libc6-dev)
        if [ "$1" = window ]; then
            packages+=(c++:g++ pkg-config:pkg-config /usr/include/libudev.h:libudev-dev)
        fi
    fi
    need_packages "${packages[@]}"
}

# build_program KIND: builds the program, and puts it without its debug symbols into target/run/KIND. The symbols lie beside it in
# spandrel.debug, where debuggers and panics find them.
build_program() {
    local features=()
    if [ "$1" = window ]; then
        features=(--features view,gamepad)
    fi
    cargo build --release --bin spandrel "${features[@]}"
    split_symbols target/release/spandrel "target/run/$1"
}

# split_symbols PROGRAM FOLDER: a copy of the program without its symbols, and its symbols, if they are older than the program.
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
    # Whoever runs the old one goes on with it.
    mv "$folder/$name.new" "$folder/$name"
}

install_packages() {
    say "Missing system packages: $*"
    if ! command -v apt-get >/dev/null 2>&1; then
        say "This is not Debian or Ubuntu: install the equivalent packages and run this again."
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
    # What is installed stays as it is, unless a new package depends on a newer version of it.
    local options=(--no-install-recommends --no-upgrade --no-remove) upgraded
    upgraded=$(apt-get install --simulate "${options[@]}" "$@" | sed -n 's/^Inst \([^ ]*\) \[.*/\1/p' | tr '\n' ' ')
    if [ -n "$upgraded" ]; then
        say "They depend on newer versions of these, which are upgraded: $upgraded"
    fi
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y "${options[@]}" "$@"
}
