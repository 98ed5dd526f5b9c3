"""A study on Ray: with workers killed and a node lost, the bytes are those of one thread."""

import os
import signal
import threading
import time

import pytest

import modl

ray = pytest.importorskip("ray")

SLOW = """record Row { sum: Number }
study slow(n in [1, 2, 3], x in 0.0..1) by sobol(40) = Row(sum: sum([(i * n) % 7 for i in 0..40000]) + x)
"""


@pytest.fixture
def slow(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RAY_USAGE_STATS_ENABLED", "0")
    (tmp_path / "slow.mod").write_text(SLOW)
    return modl.study("slow.mod", out="whole", threads=1).file.read_bytes()


def _kill_workers(count: int, stopped: threading.Event) -> list:
    """Kill processes of Ray's workers that run tasks, one after the other."""
    killed = []

    def work():
        while len(killed) < count and not stopped.is_set():
            for folder in os.listdir("/proc"):
                try:
                    with open(f"/proc/{folder}/cmdline", "rb") as stream:
                        words = stream.read()
                except OSError:
                    continue
                if words.startswith(b"ray::_shard") and int(folder) not in killed:
                    os.kill(int(folder), signal.SIGKILL)
                    killed.append(int(folder))
                    break
            time.sleep(0.3)

    threading.Thread(target=work, daemon=True).start()
    return killed


def test_workers_that_are_killed_change_nothing(slow):
    import modl.ray

    ray.init(num_cpus=2, include_dashboard=False, _node_ip_address="127.0.0.1")
    stopped = threading.Event()
    try:
        killed = _kill_workers(2, stopped)
        table = modl.ray.study("slow.mod", out="ray", shards=8)
        assert len(killed) == 2
        assert table.file.read_bytes() == slow
    finally:
        stopped.set()
        ray.shutdown()


def test_a_node_that_is_lost_changes_nothing(slow):
    import modl.ray
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    try:
        second = cluster.add_node(num_cpus=1)
        ray.init(address=cluster.address)
        threading.Timer(1.0, lambda: cluster.remove_node(second, allow_graceful=False)).start()
        table = modl.ray.study("slow.mod", out="ray", shards=8)
        assert table.file.read_bytes() == slow
    finally:
        ray.shutdown()
        cluster.shutdown()
