"""Keeps the cores busy with the runs that the tasks of a sweep want."""
import signal
import sys
import time

from thalweg.sweep.runs import DONE, FAILED
from thalweg.sweep.tables import write_tables
from thalweg.sweep.tasks import known_runs

SECONDS_BETWEEN_LOOKS = 0.1
SECONDS_BETWEEN_LINES = 5.0


class Runner:
    """plan, tasks: of the sweep; units: of the case's keys; jobs: runs at a time; tables: whether to write them, which
    is not for one of several sweeps that share a folder."""

    def __init__(self, plan, tasks, units, program, folder, jobs, retry=False, tables=True):
        self.plan, self.tasks, self.units, self.program, self.folder, self.tables = (
            plan, tasks, units, program, folder, tables,
        )
        self.jobs = jobs
        self.going = {}   # by run: (process, when it was started)
        self.dropped = set()   # going, asked to stop because the others have settled what they were to show
        self.found = None   # runs that are wanted, until one of them changes
        self.stopping = False
        self.printed, self.said = 0.0, None
        if retry:
            for run in known_runs(tasks):
                if run.state == FAILED:
                    run.remember(None)
                    run.look()

    def work(self):
        """Until all tasks are done or a signal asks to stop. Returns whether all are done."""
        heeded = [signal.SIGINT, signal.SIGTERM]
        if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:   # as nohup has it
            heeded.append(signal.SIGHUP)
        before = {number: signal.signal(number, self.stop) for number in heeded}
        try:
            while True:
                self.collect()
                self.drop_unwanted()
                waiting = self.waiting()
                self.start(waiting)
                if not self.going and (self.stopping or not waiting):
                    break
                self.report()
                time.sleep(SECONDS_BETWEEN_LOOKS)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
            for process, _ in self.going.values():   # after an exception
                process.send_signal(signal.SIGUSR1)
            for process, _ in self.going.values():   # the end of this one would kill the ranks of those still saving
                process.wait()
        self.report(last=True)
        return not self.waiting()

    def stop(self, *_):
        """The runs that are going save their state and stop; mpirun passes this signal on to its ranks."""
        self.stopping = True
        for process, _ in self.going.values():
            process.send_signal(signal.SIGUSR1)

    def wanted(self):
        if self.found is None:
            self.found = [run for task in self.tasks for run in task.wanted()]
            self.found += [run for task in self.tasks for run in task.spare()]
        return self.found

    def waiting(self):
        return [run for run in self.wanted() if run not in self.going]

    def drop_unwanted(self):
        for run in set(self.going) - set(self.wanted()) - self.dropped:
            self.going[run][0].send_signal(signal.SIGUSR1)
            self.dropped.add(run)

    def start(self, waiting):
        for run in waiting:
            if self.stopping or len(self.going) >= self.jobs:
                return
            process = run.start(self.program)
            if not process:
                self.found = None   # another sweep may have ended it
            else:
                self.going[run] = (process, time.monotonic())
                if self.stopping:   # a signal came while it was being started
                    process.send_signal(signal.SIGUSR1)

    def collect(self):
        ended = [run for run, (process, _) in self.going.items() if process.poll() is not None]
        for run in ended:
            process, _ = self.going.pop(run)
            self.take_note_of(run, process.returncode)
            run.release()
            self.found = None
        if ended and self.tables:
            write_tables(self.plan, self.tasks, self.units, self.folder)

    def take_note_of(self, run, exit_code):
        if self.stopping or run in self.dropped:
            self.dropped.discard(run)
            run.look()
            return
        run.ended(exit_code)
        if run.state == FAILED:
            self.say(f"{run.name} failed: {run.failure}")
        elif run.state != DONE:
            run.remember("the run was stopped from outside before its end")

    def progress(self):
        """e.g. "12 of 90 runs done, 1 failed, 2 going" and ", left about 3:20"."""
        runs = [run for task in self.tasks for run in task.runs]
        done, failed = (sum(run.state == state for run in runs) for state in (DONE, FAILED))
        left = sum(task.most_runs_left() for task in self.tasks)
        at_most = "at most " if self.plan.bisections and left else ""
        text = f"{done} of {at_most}{done + failed + left} runs done"
        text += (f", {failed} failed" if failed else "") + (f", {len(self.going)} going" if self.going else "")
        estimate = ""
        times = [run.wall_seconds for run in runs if run.state == DONE]
        if times and left:
            mean, now = sum(times) / len(times), time.monotonic()
            going = sum(min(mean, now - begun) for _, begun in self.going.values())
            beside = min(
                self.jobs, max(1, len(self.wanted()))
            )  # a bisection needs the result of a run to choose the next
            estimate = f", left {at_most or 'about '}{clock_text((left * mean - going) / beside)}"
        return text, estimate

    def report(self, last=False):
        now = time.monotonic()
        if last or now - self.printed >= SECONDS_BETWEEN_LINES:
            self.printed = now
            counts, estimate = self.progress()
            self.say(counts, estimate, passing=not last)

    def say(self, text, estimate="", passing=False):
        """passing: on a terminal the next line takes its place; a file gets it only when the text has changed; a new
        estimate alone does not count."""
        if sys.stdout.isatty():
            print(f"\r{text + estimate:<100}", end="" if passing else "\n", flush=True)
        elif text != self.said:
            self.said = text
            print(text + estimate, flush=True)


def clock_text(seconds):
    whole = max(0, round(seconds))
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}" if whole >= 60 else f"{whole} s"
