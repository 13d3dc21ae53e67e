# Functions for bash scripts that set up a bare Debian system in a folder and run commands in it.

# Prints why no such system can be set up on this machine; prints nothing if one can.
no_bare_system() {
  if [ "$(id -u)" != 0 ]; then
    echo "it needs root for a chroot"
  elif ! unshare --mount --pid --fork --kill-child true 2>/dev/null; then
    echo "unshare --mount --pid is not allowed here"
  elif ! command -v mmdebstrap >/dev/null; then
    echo "mmdebstrap is missing: scripts/setup --bare"
  fi
}

# make_bare_system SUITE ROOT: installs the Debian release SUITE in the folder ROOT, from this machine's mirror and with
# its settings. Fails with the reason if the packages are not available.
make_bare_system() (
  set -euo pipefail
  suite=$1 root=$2
  made=$root.made
  mkdir -p "$made"
  trap 'rm -rf "$made"' EXIT
  own=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  files=()
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
    grep -qsE '^[^#]*https?://[^ ]*/debian' "$file" || continue
    sed "s/\b${own:-$suite}\b/$suite/g" "$file" >"$made/${file##*/}"
    files+=("$made/${file##*/}")
  done
  apt-config dump | grep -E '^Acquire::' >"$made/apt.conf" || true  # proxies and certificate authorities
  mmdebstrap --quiet --variant=minbase --aptopt="$made/apt.conf" --dpkgopt=force-unsafe-io "$suite" "$root" "${files[@]}" \
    >"$made/told" 2>&1 || { cat "$made/told" >&2; exit 1; }
  # Copies settings that a private network needs.
  for folder in apt/apt.conf.d apt/auth.conf.d; do
    [ ! -d "/etc/$folder" ] || cp -a "/etc/$folder/." "$root/etc/$folder/"
  done
  for file in /etc/resolv.conf /etc/hosts /etc/ssl/certs/ca-certificates.crt /root/.npmrc; do
    [ ! -f "$file" ] || { mkdir -p "$root${file%/*}" && cp -L "$file" "$root$file"; }
  done
  if [ -d /usr/local/share/ca-certificates ]; then
    mkdir -p "$root/usr/local/share/ca-certificates"
    cp -a /usr/local/share/ca-certificates/. "$root/usr/local/share/ca-certificates/"
  fi
)

# inside ROOT COMMAND...: runs a command in ROOT. Its mounts and all processes that it starts end with it. If
# $read_only_folder is set, that folder is mounted at the same path.
inside() {
  read_only_folder=${read_only_folder:-} unshare --mount --pid --fork --kill-child bash -c '
    set -e
    mount --rbind /dev "$0/dev"
    mount -t proc proc "$0/proc"
    mount --rbind /sys "$0/sys"
    if [ -n "$read_only_folder" ]; then
      mkdir -p "$0$read_only_folder"
      mount --bind -o ro "$read_only_folder" "$0$read_only_folder"
    fi
    exec chroot "$0" "$@"' "$1" /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive CI="${CI:-}" \
    NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    "${@:2}"
}
