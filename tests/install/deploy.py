#!/usr/bin/python3
"""deploy.py PROGRAMS SOURCES: the files in packaging/deploy are sound, and their command lines render a picture.

No container runs here: the words of each file start the same programs in folders that stand for volumes, with keys that
make_keys.sh makes. Ends with 77 where YAML can't be read."""
import json, os, pathlib, re, shutil, socket, subprocess, sys, tempfile, time

try:
    import yaml
except ImportError:
    print("not run: Python's package yaml (Debian: python3-yaml) is not here")
    sys.exit(77)

programs, sources = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
deploy = sources / "packaging/deploy"
graphs = sources / "graphs"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return str(one.getsockname()[1])


def substitute(text, variables):
    """As compose does: ${NAME}, ${NAME:-usual}, ${NAME:?what lacks}."""
    def value(match):
        name, how, rest = match.group(1), match.group(2), match.group(3)
        if variables.get(name):
            return variables[name]
        assert how != ":?", f"{name} is not set: {rest}"
        return rest or ""
    return re.sub(r"\$\{(\w+)(?:(:-|:\?)([^}]*))?\}", value, text)


class Farm:
    """Folders for what a file mounts, and the programs of its command lines."""

    def __init__(self, folder):
        self.folder, self.running = pathlib.Path(folder), []
        self.port, self.metrics = free_port(), free_port()
        for name in ("pictures", "cache", "keys"):
            (self.folder / name).mkdir(exist_ok=True)
        made = subprocess.run([deploy / "make_keys.sh", self.folder / "keys"], env=self.environment(), check=True,
                              capture_output=True, text=True)
        self.launcher_key = made.stdout.strip().removeprefix("LIGHTNET_LAUNCHER_KEY=")
        assert self.launcher_key == (self.folder / "keys/launcher.pub").read_text(), made.stdout

    def environment(self):
        return {"PATH": f"{programs}:/usr/bin:/bin", "HOME": str(self.folder / "home")}

    def here(self, word, paths):
        """The same word on this machine, with its ports and folders."""
        for inside, outside in paths.items():
            word = word.replace(inside, str(outside))
        word = word.replace("tcp://launcher:7000", f"tcp://127.0.0.1:{self.port}")
        word = word.replace("tcp://0.0.0.0:7000", f"tcp://127.0.0.1:{self.port}")
        word = re.sub(r"(0\.0\.0\.0|127\.0\.0\.1):9100", f"127.0.0.1:{self.metrics}", word)
        return word.replace("/usr/share/lightnet/graphs", str(graphs))

    def start(self, words):
        self.running.append(subprocess.Popen(words, env=self.environment(), cwd=self.folder, text=True,
                                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT))
        return self.running[-1]

    def render(self, daemon, launcher, picture):
        """Joined by the daemon, the launcher renders; then the daemon is told to stop."""
        help_daemon = self.start(daemon)
        small = ["--size=32x32", "--samples=4"]
        run = self.start(launcher + small)
        try:
            said = run.communicate(timeout=120)[0]
        except subprocess.TimeoutExpired:
            run.kill()
            raise AssertionError(run.communicate()[0])
        assert run.returncode == 0, f"{launcher}: {run.returncode}\n{said}"
        health = subprocess.run([deploy / "health.sh", f"127.0.0.1:{self.metrics}"], env=self.environment())
        assert health.returncode == 0, "the daemon is not well"
        help_daemon.terminate()
        log = help_daemon.communicate(timeout=60)[0]
        assert help_daemon.returncode == 0, log
        for line in log.splitlines():
            json.loads(line)
        health = subprocess.run([deploy / "health.sh", f"127.0.0.1:{self.metrics}"], env=self.environment(),
                                stderr=subprocess.DEVNULL)
        assert health.returncode != 0, "nobody is there, and is called well"
        report = json.loads(picture.with_suffix(".run.json").read_text())
        assert report["mode"] == "network" and report["hosts"][0]["peak_memory"] > 0, report["hosts"]
        return picture.read_bytes()

    def end(self):
        for process in self.running:
            if process.poll() is None:
                process.kill()
            process.wait()


def reference(folder):
    picture = pathlib.Path(folder) / "reference.exr"
    subprocess.run([programs / "lightnet", "run", graphs / "cornell.lua", "--size=32x32", "--samples=4", "--threads=1",
                    "--progress=none", "-o", picture], check=True)
    return picture.read_bytes()


def compose(folder):
    farm = Farm(folder)
    try:
        variables = {"LIGHTNET_LAUNCHER_KEY": farm.launcher_key}
        file = yaml.safe_load(substitute((deploy / "compose.yaml").read_text(), variables))
        daemon, launcher = file["services"]["daemon"], file["services"]["launcher"]
        for service in (daemon, launcher):
            for mount in service["volumes"]:
                name = mount.split(":")[0]
                assert name.startswith("./") or name in file["volumes"], f"{mount} is nowhere"
            assert set(service["networks"]) <= set(file["networks"])
        paths = {"/keys/": f"{farm.folder}/keys/", "/cache": farm.folder / "cache", "/pictures/": f"{farm.folder}/pictures/"}
        words = lambda service: [farm.here(str(word), paths) for word in service["entrypoint"] + service["command"]]
        return farm.render(words(daemon), words(launcher), farm.folder / "pictures/cornell.exr")
    finally:
        farm.end()


def kubernetes(folder):
    farm = Farm(folder)
    try:
        objects = {(one["kind"], one["metadata"]["name"]): one
                   for one in yaml.safe_load_all((deploy / "kubernetes.yaml").read_text())}
        daemon = objects["Deployment", "lightnetd"]["spec"]["template"]
        launcher = objects["Job", "lightnet-picture"]["spec"]["template"]
        assert objects["Service", "launcher"]["spec"]["selector"] == launcher["metadata"]["labels"]
        assert objects["Deployment", "lightnetd"]["spec"]["selector"]["matchLabels"] == daemon["metadata"]["labels"]

        secrets = {"lightnet-farm": {"key": "farm"}, "lightnet-launcher": {"key": "launcher", "farm.keys": "farm.keys"}}
        values = {"POD_NAME": "lightnetd-0", "LAUNCHER_KEY": farm.launcher_key}

        def words(pod):
            container, paths = pod["spec"]["containers"][0], {}
            volumes = {volume["name"]: volume for volume in pod["spec"]["volumes"]}
            for mount in container["volumeMounts"]:
                volume = volumes[mount["name"]]
                place = farm.folder / f"{pod['metadata']['labels']['app']}-{mount['name']}"
                place.mkdir()
                paths[mount["mountPath"]] = place
                if "secret" in volume:
                    assert volume["secret"]["defaultMode"] in (0o440, 0o400), "others could read the key"
                    for name, key in secrets[volume["secret"]["secretName"]].items():
                        shutil.copy(farm.folder / "keys" / key, place / name)
                        # A Secret is root's and read by the pod's group; a file of one's own must not be.
                        (place / name).chmod(0o400)
            for variable in container.get("env", []):
                assert variable["name"] in values, variable
            text = [re.sub(r"\$\((\w+)\)", lambda name: values[name.group(1)], word)
                    for word in container["command"] + container["args"]]
            paths["/pictures/"] = f"{farm.folder}/pictures/"
            paths.pop("/pictures", None)
            paths.pop("/tmp")  # no word names it
            return [farm.here(word, paths) for word in text]

        for pod in (daemon, launcher):
            container = pod["spec"]["containers"][0]
            assert pod["spec"]["securityContext"]["fsGroup"] == 1000
            assert container["securityContext"]["readOnlyRootFilesystem"], "it writes nowhere but where it should"
        probe = daemon["spec"]["containers"][0]["livenessProbe"]["httpGet"]
        assert probe["path"] == "/healthz" and probe["port"] in [port["name"] for port in daemon["spec"]["containers"][0]["ports"]]
        return farm.render(words(daemon), words(launcher), farm.folder / "pictures/cornell.exr")
    finally:
        farm.end()


def in_folder(work):
    with tempfile.TemporaryDirectory() as folder:
        return work(folder)


wanted = in_folder(reference)
assert in_folder(compose) == wanted, "compose.yaml makes other bytes"
assert in_folder(kubernetes) == wanted, "kubernetes.yaml makes other bytes"
entries = (sources / "Containerfile").read_text()
for entry in ("EXPOSE 7777", "HEALTHCHECK ", "VOLUME ", 'CMD ["lightnetd"]'):
    assert entry in entries, f"the Containerfile has lost {entry}"
