#!/usr/bin/env python3
"""Says "success", "running" or "failed" of the Slurm job in argv[1], as Snakemake's cluster-status asks. Without accounting: scontrol alone."""
import subprocess
import sys

RUNNING = {"PENDING", "CONFIGURING", "RUNNING", "COMPLETING", "SUSPENDED", "REQUEUED", "RESIZING", "SIGNALING", "STAGE_OUT", "STOPPED"}

asked = subprocess.run(["scontrol", "show", "job", "--oneliner", sys.argv[1]], capture_output=True, text=True)
fields = dict(field.split("=", 1) for field in asked.stdout.split() if "=" in field)
state = fields.get("JobState", "")
if asked.returncode != 0 and "Invalid job id" not in asked.stderr:
    print("running")  # the controller does not answer: ask again
elif state in RUNNING:
    print("running")
else:
    print("success" if state == "COMPLETED" else "failed")  # a job that is forgotten has failed: what it made is looked for anyway
