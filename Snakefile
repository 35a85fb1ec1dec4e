# The whole pipeline on one page, in the order of the data: each rule runs the stage of its name,
# and each stage writes its tables into data/derived/<campaign>/<stage>/.

import json
import os
import sys
from pathlib import Path

from snakemake.utils import min_version, validate

min_version("9.0")

# Snakemake would load it, for half a second, to ask of each parameter whether it is a table.
sys.modules["pandas"] = None

HOME = Path(workflow.basedir)
sys.path.insert(0, str(HOME))
os.environ["PYTHONPATH"] = str(HOME)  # the data may lie elsewhere (--directory)
os.environ["OPENBLAS_NUM_THREADS"] = "1"  # two stages run at a time, on small matrices

from inertial.tables.code import code_of
from inertial.tables.campaign_files import campaigns, logs_of
from stages.starting import prepared


configfile: HOME / "config.yaml"


validate(config, str(HOME / "inertial/tables/config.schema.yaml"))

PYTHON = sys.executable
DERIVED = "data/derived/{campaign}"
RAW = "data/raw/{campaign}"
SIMULATED = campaigns("data/simulated", "*.yaml")
CAMPAIGNS = sorted({*campaigns("data/raw", "*/campaign.yaml"), *SIMULATED})
LABORATORY = sorted(
    str(p) for p in (HOME / "laboratory").rglob("*") if p.suffix in {".py", ".yaml"}
)

# A stage is asked for where its packages are loaded already; that process ends with this one.
ASK = str(HOME / "stages/starting/ask.py")
SOCKET = f".snakemake/prepared-{os.getpid()}"
PREPARED = []
RUN = "{PYTHON:q} -I -S {ASK:q} {SOCKET:q} {rule}"

# Every stage is run alike: `--name=path` for each input, quoted for the shell.
STAGE = RUN + (
    " --settings {params.settings:q} {params.reads:q} --output {params.output:q} 2> {log:q}"
)


def reads(wildcards, input):
    """The arguments that name a stage's inputs; its code is an input for Snakemake alone."""
    named = [(name, paths) for name, paths in input.items() if name != "code"]
    return [
        f"--{name}={path}"
        for name, paths in named
        for path in ([paths] if isinstance(paths, str) else paths)
    ]


def code(stage):
    """Every file of the project that a stage rests on: when one changes, the stage runs again."""
    return [str(path) for path in code_of(stage)]


def settings(stage):
    """The section of config.yaml that a stage gets, and no other, so that only it runs again."""
    return json.dumps(config.get(stage, {}), sort_keys=True)


def logs(wildcards):
    """The logs of a campaign: of the simulated one by its description, for they may not be there yet."""
    simulated = wildcards.campaign in SIMULATED
    source = "data/simulated/{campaign}.yaml" if simulated else f"{RAW}/campaign.yaml"
    files = [f"{RAW}/{log}" for log in logs_of(Path(source.format(**wildcards)))]
    files = [file.format(**wildcards) for file in files]
    return [file for file in files if simulated or Path(file).is_file()]


def published(wildcards):
    """What others published of the IMU, where the laboratory has put it beside its campaign."""
    file = f"{RAW}/published.yaml".format(**wildcards)
    return [file] if Path(file).is_file() else []


onstart:
    if sys.platform == "linux":  # elsewhere a process that has loaded so much may not fork
        PREPARED.append(prepared.begin(Path(SOCKET)))


wildcard_constraints:
    campaign="[a-z0-9][a-z0-9-]*",


rule all:
    default_target: True
    input:
        expand("reports/{campaign}.{kind}", campaign=CAMPAIGNS, kind=["html", "pdf"]),
        expand(f"{DERIVED}/comparison/differences.parquet", campaign=CAMPAIGNS),
        expand(f"{DERIVED}/compensation/checks.parquet", campaign=CAMPAIGNS),
        expand(f"{DERIVED}/history/archived.parquet", campaign=CAMPAIGNS),
        expand("reports/{campaign}.calibration.json", campaign=CAMPAIGNS),


for simulated in SIMULATED:

    rule:
        name:
            f"laboratory_{simulated}"
        input:
            description=f"data/simulated/{simulated}.yaml",
            code=LABORATORY,
        output:
            [
                f"data/raw/{simulated}/{log}"
                for log in logs_of(Path(f"data/simulated/{simulated}.yaml"))
            ],
            f"data/raw/{simulated}/campaign.yaml",
        log:
            f"data/derived/{simulated}/laboratory/stage.log",
        params:
            output=f"data/raw/{simulated}",
        message:
            f"{simulated}: the simulated laboratory records"
        shell:
            "{PYTHON:q} -m laboratory {input.description:q} {params.output:q} 2> {log:q}"


rule plan:
    input:
        campaign=f"{RAW}/campaign.yaml",
        raw=logs,
        instruments=HOME / "data/instruments.yaml",
        published=published,
        code=code("plan"),
    output:
        multiext(
            f"{DERIVED}/plan/",
            "campaign.parquet",
            "known.parquet",
            "sensors.parquet",
            "logs.parquet",
            "ranges.parquet",
            "count_sizes.parquet",
            "inputs.parquet",
            "published.parquet",
            "manoeuvres.parquet",
        ),
    log:
        f"{DERIVED}/plan/stage.log",
    params:
        settings=settings("plan"),
        reads=reads,
        output=f"{DERIVED}/plan",
    message:
        "{wildcards.campaign}: the campaign file, checked and made explicit"
    shell:
        STAGE


rule decode:
    input:
        logs=f"{DERIVED}/plan/logs.parquet",
        raw=logs,
        code=code("decode"),
    output:
        multiext(
            f"{DERIVED}/decode/",
            "samples.parquet",
            "refused.parquet",
            "accounts.parquet",
            "clocks.parquet",
        ),
    log:
        f"{DERIVED}/decode/stage.log",
    params:
        settings=settings("decode"),
        reads=reads,
        output=f"{DERIVED}/decode",
    message:
        "{wildcards.campaign}: logs to samples"
    shell:
        STAGE


rule quality:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        campaign=f"{DERIVED}/plan/campaign.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        ranges=f"{DERIVED}/plan/ranges.parquet",
        count_sizes=f"{DERIVED}/plan/count_sizes.parquet",
        code=code("quality"),
    output:
        multiext(
            f"{DERIVED}/quality/",
            "findings.parquet",
            "masks.parquet",
            "gaps.parquet",
            "close_ups.parquet",
        ),
    log:
        f"{DERIVED}/quality/stage.log",
    params:
        settings=settings("quality"),
        reads=reads,
        output=f"{DERIVED}/quality",
    message:
        "{wildcards.campaign}: what is wrong with the recording?"
    shell:
        STAGE


rule segment:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        campaign=f"{DERIVED}/plan/campaign.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        ranges=f"{DERIVED}/plan/ranges.parquet",
        count_sizes=f"{DERIVED}/plan/count_sizes.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        gaps=f"{DERIVED}/quality/gaps.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        code=code("segment"),
    output:
        multiext(
            f"{DERIVED}/segment/",
            "segments.parquet",
            "performed.parquet",
            "blocks.parquet",
            "traces.parquet",
            "findings.parquet",
            "close_ups.parquet",
        ),
    log:
        f"{DERIVED}/segment/stage.log",
    params:
        settings=settings("segment"),
        reads=reads,
        output=f"{DERIVED}/segment",
    message:
        "{wildcards.campaign}: where are the manoeuvres of the plan?"
    shell:
        STAGE


rule noise:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        segments=f"{DERIVED}/segment/segments.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        gaps=f"{DERIVED}/quality/gaps.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        sensors=f"{DERIVED}/plan/sensors.parquet",
        code=code("noise"),
    output:
        f"{DERIVED}/noise/noise.parquet",
    log:
        f"{DERIVED}/noise/stage.log",
    params:
        settings=settings("noise"),
        reads=reads,
        output=f"{DERIVED}/noise",
    message:
        "{wildcards.campaign}: how much white noise?"
    shell:
        STAGE


rule accelerometer:
    input:
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        code=code("accelerometer"),
    output:
        multiext(
            f"{DERIVED}/accelerometer/",
            "parameters.parquet",
            "covariance.parquet",
            "fit.parquet",
            "averaging.parquet",
            "positions.parquet",
            "wanted.parquet",
            "findings.parquet",
        ),
    log:
        f"{DERIVED}/accelerometer/stage.log",
    params:
        settings=settings("accelerometer"),
        reads=reads,
        output=f"{DERIVED}/accelerometer",
    message:
        "{wildcards.campaign}: the accelerometers from rests"
    shell:
        STAGE


rule gyroscope:
    input:
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        code=code("gyroscope"),
    output:
        multiext(
            f"{DERIVED}/gyroscope/",
            "parameters.parquet",
            "covariance.parquet",
            "fit.parquet",
            "averaging.parquet",
            "positions.parquet",
            "wanted.parquet",
        ),
    log:
        f"{DERIVED}/gyroscope/stage.log",
    params:
        settings=settings("gyroscope"),
        reads=reads,
        output=f"{DERIVED}/gyroscope",
    message:
        "{wildcards.campaign}: the gyros from turns and rests"
    shell:
        STAGE


rule studies:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        segments=f"{DERIVED}/segment/segments.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        code=code("studies"),
    output:
        multiext(
            f"{DERIVED}/studies/",
            "epochs.parquet",
            "spreads.parquet",
            "windows.parquet",
            "growing.parquet",
            "middles.parquet",
            "time_angle.parquet",
            "motions.parquet",
            "not_studied.parquet",
        ),
    log:
        f"{DERIVED}/studies/stage.log",
    params:
        settings=settings("studies"),
        reads=reads,
        output=f"{DERIVED}/studies",
    message:
        "{wildcards.campaign}: S0's studies: epochs, windows, time and angle"
    shell:
        STAGE


rule comparison:
    input:
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        growing=f"{DERIVED}/studies/growing.parquet",
        motions=f"{DERIVED}/studies/motions.parquet",
        published=f"{DERIVED}/plan/published.parquet",
        code=code("comparison"),
    output:
        f"{DERIVED}/comparison/differences.parquet",
    log:
        f"{DERIVED}/comparison/stage.log",
    params:
        settings=settings("comparison"),
        reads=reads,
        output=f"{DERIVED}/comparison",
    message:
        "{wildcards.campaign}: rests against turns, method against method, others against ours"
    shell:
        STAGE


rule compensation:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        traces=f"{DERIVED}/segment/traces.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        segments=f"{DERIVED}/segment/segments.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        campaign=f"{DERIVED}/plan/campaign.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        code=code("compensation"),
    output:
        multiext(
            f"{DERIVED}/compensation/",
            "compensated.parquet",
            "checks.parquet",
            "compensated_traces.parquet",
            "findings.parquet",
        ),
    log:
        f"{DERIVED}/compensation/stage.log",
    params:
        settings=settings("compensation"),
        reads=reads,
        output=f"{DERIVED}/compensation",
    message:
        "{wildcards.campaign}: the samples with the errors taken out"
    shell:
        STAGE


rule simulation:
    input:
        samples=f"{DERIVED}/decode/samples.parquet",
        segments=f"{DERIVED}/segment/segments.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_positions=f"{DERIVED}/accelerometer/positions.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_positions=f"{DERIVED}/gyroscope/positions.parquet",
        code=code("simulation"),
    output:
        multiext(
            f"{DERIVED}/simulation/",
            "simulated.parquet",
            "fidelity.parquet",
        ),
    log:
        f"{DERIVED}/simulation/stage.log",
    priority: 1  # the longest way to the report leads here
    params:
        settings=settings("simulation"),
        reads=reads,
        output=f"{DERIVED}/simulation",
    message:
        "{wildcards.campaign}: what should the IMU have read?"
    shell:
        STAGE


rule criticism:
    input:
        simulated=f"{DERIVED}/simulation/simulated.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_positions=f"{DERIVED}/accelerometer/positions.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_positions=f"{DERIVED}/gyroscope/positions.parquet",
        accelerometer_fit=f"{DERIVED}/accelerometer/fit.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        code=code("criticism"),
    output:
        multiext(
            f"{DERIVED}/criticism/",
            "scores.parquet",
            "effects.parquet",
            "blind_spots.parquet",
            "lines.parquet",
            "findings.parquet",
            "walks.parquet",
            "structures.parquet",
            "structure_points.parquet",
        ),
    log:
        f"{DERIVED}/criticism/stage.log",
    priority: 1  # the longest way to the report leads here
    params:
        settings=settings("criticism"),
        reads=reads,
        output=f"{DERIVED}/criticism",
    message:
        "{wildcards.campaign}: what does the simulation lack?"
    shell:
        STAGE


rule extension:
    input:
        simulated=f"{DERIVED}/simulation/simulated.parquet",
        criticism_findings=f"{DERIVED}/criticism/findings.parquet",
        effects=f"{DERIVED}/criticism/effects.parquet",
        walks=f"{DERIVED}/criticism/walks.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_positions=f"{DERIVED}/accelerometer/positions.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_positions=f"{DERIVED}/gyroscope/positions.parquet",
        accelerometer_fit=f"{DERIVED}/accelerometer/fit.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        code=code("extension"),
    output:
        multiext(
            f"{DERIVED}/extension/",
            "parameters.parquet",
            "covariance.parquet",
            "fit.parquet",
            "gain.parquet",
            "moved.parquet",
            "worth.parquet",
            "decision.parquet",
            "result.parquet",
        ),
    log:
        f"{DERIVED}/extension/stage.log",
    priority: 1  # the longest way to the report leads here
    params:
        settings=settings("extension"),
        reads=reads,
        output=f"{DERIVED}/extension",
    message:
        "{wildcards.campaign}: the model with what it lacked"
    shell:
        STAGE


rule history:
    input:
        campaign=f"{DERIVED}/plan/campaign.parquet",
        inputs=f"{DERIVED}/plan/inputs.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_covariance=f"{DERIVED}/accelerometer/covariance.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_covariance=f"{DERIVED}/gyroscope/covariance.parquet",
        extension_parameters=f"{DERIVED}/extension/parameters.parquet",
        extension_covariance=f"{DERIVED}/extension/covariance.parquet",
        decision=f"{DERIVED}/extension/decision.parquet",
        code=code("history"),
    output:
        multiext(f"{DERIVED}/history/", "archived.parquet", "earlier.parquet"),
    log:
        f"{DERIVED}/history/stage.log",
    params:
        settings=settings("history"),
        # The archive is no input: what other campaigns add to it must not make this one run again.
        reads=lambda wildcards, input: [*reads(wildcards, input), "--archive=data/history"],
        output=f"{DERIVED}/history",
    message:
        "{wildcards.campaign}: into the archive of its IMU"
    shell:
        STAGE


rule export:
    input:
        campaign=f"{DERIVED}/plan/campaign.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        inputs=f"{DERIVED}/plan/inputs.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        samples=f"{DERIVED}/decode/samples.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        blocks=f"{DERIVED}/segment/blocks.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_covariance=f"{DERIVED}/accelerometer/covariance.parquet",
        accelerometer_fit=f"{DERIVED}/accelerometer/fit.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_covariance=f"{DERIVED}/gyroscope/covariance.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        extension_parameters=f"{DERIVED}/extension/parameters.parquet",
        extension_covariance=f"{DERIVED}/extension/covariance.parquet",
        extension_fit=f"{DERIVED}/extension/fit.parquet",
        decision=f"{DERIVED}/extension/decision.parquet",
        code=code("export"),
    output:
        multiext(
            "reports/{campaign}.",
            "calibration.json",
            "calibration.yaml",
            "kalibr.yaml",
            "px4.params",
            "ardupilot.param",
        ),
    log:
        f"{DERIVED}/export/stage.log",
    params:
        reads=reads,
        output="reports/{campaign}",
    message:
        "{wildcards.campaign}: the calibration for other programs"
    shell:
        RUN + " {params.reads:q} --output {params.output:q} 2> {log:q}"


rule report:
    input:
        campaign=f"{DERIVED}/plan/campaign.parquet",
        known=f"{DERIVED}/plan/known.parquet",
        sensors=f"{DERIVED}/plan/sensors.parquet",
        inputs=f"{DERIVED}/plan/inputs.parquet",
        manoeuvres=f"{DERIVED}/plan/manoeuvres.parquet",
        accounts=f"{DERIVED}/decode/accounts.parquet",
        refused=f"{DERIVED}/decode/refused.parquet",
        clocks=f"{DERIVED}/decode/clocks.parquet",
        quality_findings=f"{DERIVED}/quality/findings.parquet",
        masks=f"{DERIVED}/quality/masks.parquet",
        gaps=f"{DERIVED}/quality/gaps.parquet",
        quality_close_ups=f"{DERIVED}/quality/close_ups.parquet",
        segment_findings=f"{DERIVED}/segment/findings.parquet",
        segment_close_ups=f"{DERIVED}/segment/close_ups.parquet",
        segments=f"{DERIVED}/segment/segments.parquet",
        performed=f"{DERIVED}/segment/performed.parquet",
        traces=f"{DERIVED}/segment/traces.parquet",
        noise=f"{DERIVED}/noise/noise.parquet",
        accelerometer_parameters=f"{DERIVED}/accelerometer/parameters.parquet",
        accelerometer_fit=f"{DERIVED}/accelerometer/fit.parquet",
        accelerometer_findings=f"{DERIVED}/accelerometer/findings.parquet",
        accelerometer_averaging=f"{DERIVED}/accelerometer/averaging.parquet",
        accelerometer_wanted=f"{DERIVED}/accelerometer/wanted.parquet",
        gyroscope_parameters=f"{DERIVED}/gyroscope/parameters.parquet",
        gyroscope_fit=f"{DERIVED}/gyroscope/fit.parquet",
        gyroscope_averaging=f"{DERIVED}/gyroscope/averaging.parquet",
        gyroscope_wanted=f"{DERIVED}/gyroscope/wanted.parquet",
        epochs=f"{DERIVED}/studies/epochs.parquet",
        spreads=f"{DERIVED}/studies/spreads.parquet",
        windows=f"{DERIVED}/studies/windows.parquet",
        growing=f"{DERIVED}/studies/growing.parquet",
        middles=f"{DERIVED}/studies/middles.parquet",
        time_angle=f"{DERIVED}/studies/time_angle.parquet",
        motions=f"{DERIVED}/studies/motions.parquet",
        not_studied=f"{DERIVED}/studies/not_studied.parquet",
        simulated=f"{DERIVED}/simulation/simulated.parquet",
        fidelity=f"{DERIVED}/simulation/fidelity.parquet",
        scores=f"{DERIVED}/criticism/scores.parquet",
        effects=f"{DERIVED}/criticism/effects.parquet",
        lines=f"{DERIVED}/criticism/lines.parquet",
        blind_spots=f"{DERIVED}/criticism/blind_spots.parquet",
        structures=f"{DERIVED}/criticism/structures.parquet",
        structure_points=f"{DERIVED}/criticism/structure_points.parquet",
        criticism_findings=f"{DERIVED}/criticism/findings.parquet",
        extended_parameters=f"{DERIVED}/extension/parameters.parquet",
        extended_fit=f"{DERIVED}/extension/fit.parquet",
        gain=f"{DERIVED}/extension/gain.parquet",
        worth=f"{DERIVED}/extension/worth.parquet",
        decision=f"{DERIVED}/extension/decision.parquet",
        differences=f"{DERIVED}/comparison/differences.parquet",
        checks=f"{DERIVED}/compensation/checks.parquet",
        compensated_traces=f"{DERIVED}/compensation/compensated_traces.parquet",
        compensation_findings=f"{DERIVED}/compensation/findings.parquet",
        archived=f"{DERIVED}/history/archived.parquet",
        earlier=f"{DERIVED}/history/earlier.parquet",
        code=code("report"),
    output:
        page="reports/{campaign}.html",
        verdict="reports/{campaign}.txt",
    log:
        f"{DERIVED}/report/stage.log",
    threads: 2
    params:
        reads=reads,
    message:
        "{wildcards.campaign}: the report"
    shell:
        RUN + " {params.reads:q}"
        " --output {output.page:q} --verdict {output.verdict:q} 2> {log:q}"


rule pdf:
    input:
        html="reports/{campaign}.html",
        code=code("pdf"),
    output:
        "reports/{campaign}.pdf",
    log:
        f"{DERIVED}/pdf/stage.log",
    message:
        "{wildcards.campaign}: the report as PDF"
    shell:
        RUN + " --html {input.html:q} --output {output:q} 2> {log:q}"
