# Sourced by tools/quickstart, tools/test and tools/gpu-report, with $root set to the repository.

say() {
    printf '\n== %s\n' "$*"
}

# missing_packages KIND...: prints the packages of these kinds in tools/packages that are not installed.
missing_packages() {
    wanted=$(for kind in "$@"; do awk -v kind="$kind" '$1 == kind { print $2 }' "$root/tools/packages"; done)
    # shellcheck disable=SC2086
    installed=" $(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null |
        awk '$1 == "installed" { printf "%s ", $2 }')"
    for package in $wanted; do
        case $installed in *" $package "*) ;; *) echo "$package" ;; esac
    done
}

# install_packages KIND...: installs missing packages; touches neither network nor system when none is missing.
install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "This is no Debian: install what tools/packages names, by its names here. Going on."
        return 0
    fi
    packages=$(missing_packages "$@" | tr '\n' ' ')
    [ -n "$packages" ] || return 0
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            say "These packages are missing, and there is neither root nor sudo to install them:"
            echo "    apt-get install --no-install-recommends $packages"
            exit 1
        fi
        as_root=sudo
    fi
    say "Installing $packages"
    # shellcheck disable=SC2086
    $as_root apt-get update -q
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends \
        $packages
}

# build FOLDER OPTION...: configures FOLDER once, or again when the options changed, and builds what is stale.
build() {
    folder=$1
    shift
    jobs=$(nproc 2>/dev/null || echo 2)
    options="$*"
    if [ ! -f "$folder/build.ninja" ] || [ "$options" != "$(cat "$folder/options" 2>/dev/null)" ]; then
        cmake -S "$root" -B "$folder" -G Ninja "$@"
        printf '%s\n' "$options" >"$folder/options"
    fi
    cmake --build "$folder" -j "$jobs"
}
