# The whole pipeline, in the order of the data: each rule runs the stage of its name,
# which writes its tables into data/derived/<campaign>/<stage>/. What a stage reads and writes is
# declared in stages/<stage>/declared.py, and taken from there.

import json
import os
import sys
from functools import cache
from importlib import import_module
from pathlib import Path

from snakemake.logging import logger
from snakemake.utils import min_version, validate

min_version("9.0")

HOME = Path(str(workflow.current_basedir))  # of this file, included or a module of another
sys.path.insert(0, str(HOME))
# The data may lie elsewhere (--directory), and the environment need not be activated.
shell.prefix(f"export PATH={Path(sys.executable).parent}:$PATH PYTHONPATH={HOME}; ")

from inertial.tables.campaign_files import campaigns, logs_of
from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.failed_run import FailedRun
from inertial.tables.yaml_file import YamlFile
from overviews.fleet.declared import READ as READ_BY_FLEET
from overviews.fleet.selection import selected
from overviews.known import kept, pair_of, refuse_reserved, serials, with_result

SETTINGS = HOME / "config.yaml"
try:
    YamlFile(SETTINGS).check("config")  # with line and cure, before Snakemake reads it
except Refusal as refusal:
    sys.exit(str(refusal))


configfile: SETTINGS


validate(config, str(HOME / "inertial/tables/config.schema.yaml"))

FAILED = FailedRun(logger)


onerror:
    sys.stderr.write(FAILED.shown(*log))


DERIVED = "data/derived/{campaign}"
RAW = "data/raw/{campaign}"
SIMULATED = campaigns("data/simulated", "*.yaml")
LABORATORY = sorted(p for p in (HOME / "laboratory").rglob("*") if p.suffix in {".py", ".yaml"})
CAMPAIGNS = sorted({*campaigns("data/raw", "*/campaign.yaml"), *SIMULATED})
ARCHIVE = Path("data/history")
try:
    refuse_reserved(CAMPAIGNS)
except Refusal as refusal:
    sys.exit(str(refusal))


def declared(stage):
    """What a stage reads and writes."""
    return import_module(f"stages.{stage}.declared").DECLARED


def reads(stage):
    """The tables that a stage reads, by the arguments of its function."""
    return {name: f"{DERIVED}/{source.place}" for name, source in declared(stage).reads.items()}


def writes(stage):
    """The tables that a stage writes, or its documents."""
    tables = [f"{DERIVED}/{stage}/{name}.parquet" for name in declared(stage).writes]
    documents = [f"reports/{{campaign}}.{ending}" for ending in declared(stage).documents]
    return tables + [shown(document) for document in documents]


def shown(document, category="{campaign}"):
    """A document as snakemake --report shows it, under the campaign."""
    return report(document, category=category, labels={"document": document.partition(".")[2]})


def code(stage):
    """One hash of all files of the project that a stage rests on: it runs again when one changes."""
    return hash_of(code_of(stage))


def settings(stage):
    """The section of config.yaml that a stage gets, and no other, so that only it runs again."""
    return json.dumps(config.get(stage, {}), sort_keys=True)


def needs(stage):
    """Memory, MB, and time, minutes, of a stage: where it reads samples, by the size of the logs.

    Both with room to spare against what `benchmark:` measures, and twice as much for a second
    attempt.
    """
    reads_samples = bool("raw" in declared(stage).files or declared(stage).streams)

    def mem_mb(wildcards, attempt):
        return attempt * (1000 + reads_samples * 2 * logs_mb(wildcards.campaign))

    def runtime(wildcards, attempt):
        return attempt * (2 + reads_samples * logs_mb(wildcards.campaign) // 100)

    return {"mem_mb": mem_mb, "runtime": runtime}


def files(stage, **more):
    """The options of a stage that name files: inputs that are no tables, and its documents."""

    def of(wildcards, input):
        given = {name: input[name] for name in declared(stage).files if name in input.keys()}
        if declared(stage).documents:
            given["documents"] = f"reports/{wildcards.campaign}"
        words = []
        for name, paths in (given | more).items():
            words += [f"--{name}", *([paths] if isinstance(paths, str) else paths)]
        return words

    return of


def logs(wildcards):
    """The logs of a campaign: of a simulated one by its description, for they may not be there yet."""
    return campaign_logs(wildcards.campaign)


@cache
def campaign_logs(campaign):
    """The same, by the name of the campaign."""
    simulated = campaign in SIMULATED
    raw = Path("data/raw", campaign)
    source = f"data/simulated/{campaign}.yaml" if simulated else raw / "campaign.yaml"
    files = [str(raw / log) for log in logs_of(Path(source))]
    return [file for file in files if simulated or Path(file).is_file()]


@cache
def logs_mb(campaign):
    """The size of the logs, MB; of a simulated campaign that is not recorded yet, none."""
    sizes = (os.path.getsize(log) for log in campaign_logs(campaign) if os.path.isfile(log))
    return round(sum(sizes) / 1e6)


def published(wildcards):
    """What others published of the IMU, where the laboratory has put it beside its campaign."""
    file = f"{RAW}/published.yaml".format(**wildcards)
    return [file] if Path(file).is_file() else []


def laboratory():
    """What is the same on all certificates of the laboratory, where it has stated it."""
    return [file for file in ["data/laboratory.yaml"] if Path(file).is_file()]


def results(*campaigns):
    """The tables that are the result of campaigns, on which pages of several rest."""
    stages = ("plan", "segment", "diagnosis", "compensation", "history")
    names = [f"{stage}/{name}" for stage in stages for name in declared(stage).writes]
    return expand("data/derived/{campaign}/{name}.parquet", campaign=campaigns, name=names)


def with_serial(wildcards):
    """The results of the campaigns that the archive has of a serial number, where they are here."""
    here = with_result(CAMPAIGNS, Path("data/derived"))
    files = kept(ARCHIVE, wildcards.serial)
    return results(*(c for c in here if any(f"-{c}-" in Path(file).name for file in files)))


def compared(wildcards):
    """The results of the two campaigns of a comparison."""
    return results(*pair_of(wildcards.pair, CAMPAIGNS))


def in_fleet(wildcards):
    """The campaigns of a fleet: that are named, or whose results are there and are as wanted."""
    try:
        return selected(wildcards.fleet, CAMPAIGNS, Path("data/derived"))
    except Refusal as refusal:
        sys.exit(str(refusal))


def pages():
    """The pages to which others lead, where they are."""
    return [p for p in map("reports/{}.html".format, CAMPAIGNS) if Path(p).is_file()]


def overview_settings():
    """What pages of several campaigns depend on in config.yaml."""
    language = {"language": config.get("report", {}).get("language", "en")}
    own = {name: config[name] for name in ("history", "comparison", "fleet")}
    return json.dumps(own | language, sort_keys=True)


wildcard_constraints:
    campaign="(?!index$|compare-|fleet-)[a-z0-9][a-z0-9-]*",
    pair="[a-z0-9][a-z0-9-]*",
    fleet="[a-z0-9][a-z0-9-]*",
    serial="[^/]+",


rule all:
    default_target: True
    input:
        expand("reports/{campaign}.{kind}", campaign=CAMPAIGNS, kind=["html", "pdf"]),
        expand("reports/{campaign}.calibration.json", campaign=CAMPAIGNS),
        expand(f"{DERIVED}/history/archived.parquet", campaign=CAMPAIGNS),


for simulated in SIMULATED:

    rule:
        name:
            f"laboratory_{simulated}"
        input:
            f"data/simulated/{simulated}.yaml",
        output:
            [
                f"data/raw/{simulated}/{log}"
                for log in logs_of(Path(f"data/simulated/{simulated}.yaml"))
            ],
            f"data/raw/{simulated}/campaign.yaml",
        log:
            f"data/derived/{simulated}/laboratory/stage.log",
        benchmark:
            f"data/derived/{simulated}/laboratory/benchmark.tsv"
        group:
            "campaign"
        threads: 1
        resources:
            mem_mb=2000,
            runtime=10,
        params:
            output=lambda wildcards, output: Path(output[-1]).parent,
            code=hash_of(LABORATORY),
        message:
            f"{simulated}: the simulated laboratory records"
        shell:
            "python -m laboratory {input:q} {params.output:q} 2> {log:q}"


STAGES = {  # in the order of the data, each with what it makes
    "plan": "the campaign file, checked and made explicit",
    "decode": "logs to samples",
    "quality": "faults of the recording",
    "segment": "the manoeuvres of the plan in the logs",
    "noise": "white noise of every channel",
    "accelerometer": "the accelerometers from static positions",
    "gyroscope": "the gyros from rate segments and static positions",
    "studies": "averaging time, epochs, windows, time and angle",
    "comparison": "static against rotation, method against method",
    "simulation": "what the IMU should have read",
    "criticism": "unmodelled effects by name",
    "extension": "the model with these effects, and its gain on held-out manoeuvres",
    "diagnosis": "causes, the one result that counts, and the verdict",
    "compensation": "the samples with the errors taken out",
    "navigation": "free inertial navigation before and after calibration",
    "alignment": "alignment at rest, and the attitude error with and without rotation",
    "history": "into the archive of its IMU, and against published values",
    "export": "the calibration for other programs",
    "report": "the report",
    "pdf": "the report as PDF",
}
FILES = {  # that stages read beside the tables
    "plan": {
        "campaign": f"{RAW}/campaign.yaml",
        "raw": logs,
        "instruments": HOME / "data/instruments.yaml",
        "published": published,
        "laboratory": laboratory(),
    },
    "decode": {"raw": logs},
    "pdf": {
        "html": "reports/{campaign}.html",
        "attached": ["reports/{campaign}.calibration.json", "reports/{campaign}.dcc.xml"],
    },
}
PATHS = {"history": {"archive": "data/history"}}  # that are no input, for a stage changes them
LONGEST = {"simulation", "criticism", "extension"}  # the longest way to the report has these


for stage, makes in STAGES.items():

    rule:
        name:
            stage
        input:
            **reads(stage),
            **FILES.get(stage, {}),
        output:
            writes(stage),
        log:
            f"{DERIVED}/{stage}/stage.log",
        benchmark:
            f"{DERIVED}/{stage}/benchmark.tsv"
        priority: int(stage in LONGEST)
        group:
            "campaign"
        threads: 1
        resources:
            **needs(stage),
        params:
            command=f"python -m stages {stage}",
            settings=settings(stage),
            files=files(stage, **PATHS.get(stage, {})),
            code=code(stage),
        message:
            f"{{wildcards.campaign}}: {makes}"
        shell:  # by params, for it is read when the job runs, and the loop is over
            "{params.command} data/derived/{wildcards.campaign:q}"
            " --settings {params.settings:q} {params.files:q} 2> {log:q}"


# ---- Pages of several campaigns: of those whose result is there when a run begins; a change of it
# reruns them.


rule index:
    input:
        lambda wildcards: results(*with_result(CAMPAIGNS, Path("data/derived"))),
    output:
        shown("reports/index.html", "all campaigns"),
    log:
        "data/derived/.overviews/index.log",
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        campaigns=CAMPAIGNS,
        archive=kept(ARCHIVE),
        pages=pages() + [f"reports/history/{serial}.html" for serial in serials(ARCHIVE)],
        settings=overview_settings(),
        code=hash_of(code_of("index", "overviews")),
    message:
        "all campaigns on one page"
    shell:
        "python -m overviews index {params.campaigns:q} --settings {params.settings:q} 2> {log:q}"


rule histories:
    input:
        [f"reports/history/{serial}.html" for serial in serials(ARCHIVE)],


rule history_page:
    input:
        with_serial,
    output:
        shown("reports/history/{serial}.html", "{serial}"),
    log:
        "data/derived/.overviews/history-{serial}.log",
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        archive=lambda wildcards: kept(ARCHIVE, wildcards.serial),
        pages=pages(),
        settings=overview_settings(),
        code=hash_of(code_of("history", "overviews")),
    message:
        "{wildcards.serial}: the history of an IMU"
    shell:
        "python -m overviews history {wildcards.serial:q} --settings {params.settings:q} 2> {log:q}"


rule compare:
    input:
        compared,
    output:
        shown("reports/compare-{pair}.html", "{pair}"),
        "reports/compare-{pair}.txt",
    log:
        "data/derived/.overviews/compare-{pair}.log",
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        both=lambda wildcards: pair_of(wildcards.pair, CAMPAIGNS),
        settings=overview_settings(),
        code=hash_of(code_of("compare", "overviews")),
    message:
        "{params.both[0]} and {params.both[1]} beside each other"
    shell:
        "python -m overviews compare {params.both:q} --settings {params.settings:q} 2> {log:q}"


rule fleet:
    input:
        "data/fleets/{fleet}.txt",
        lambda wildcards: [
            f"data/derived/{campaign}/{read.place}"
            for campaign in in_fleet(wildcards)
            for read in READ_BY_FLEET.values()
        ],
    output:
        "reports/fleet-{fleet}.html",
    log:
        "data/derived/.overviews/fleet-{fleet}.log",
    params:
        campaigns=in_fleet,
        settings=overview_settings(),
        code=hash_of(code_of("fleet", "overviews")),
    message:
        "{wildcards.fleet}: what the campaigns of a fleet show together"
    shell:
        "python -m overviews fleet {wildcards.fleet:q} {params.campaigns:q}"
        " --settings {params.settings:q} 2> {log:q}"
