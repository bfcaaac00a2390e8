"""What the sources demand to be said besides the formulas (`report` in answers.json), each as a test of the answer."""

from sheet import need


def texts(answer, item=None):
    steps = [s.get("text", "") for i in answer.items() if item is None or item in i["item"] for s in i["steps"]]
    return " ".join(steps)


def noted(answer, code):
    need(answer.notes(code), f"no {code}: {[n['code'] for n in answer.document['notes']]}")


def equilibrium_start(solve):
    noted(solve("P03", "--set", "θ0=0", "--no-simulation"), "N061")
    need("equilibrium" in texts(solve("P03", "--no-simulation"), "force of hill"), "the closed form does not say that its start is one")


def continuum(solve):
    answer = solve("P09", "--set", "ω=sqrt(2 g k)", "--no-simulation")
    rest = answer.value("equilibrium 1", item="equilibria")
    need(rest["free"] == ["rho"], f"free: {rest.get('free')}")


def axis_of_the_cone(solve):
    singular = texts(solve("P26", "--no-simulation"), "lagrange2") + texts(solve("P26_axis", "--no-simulation"), "equilibria")
    need("singular" in singular, f"nothing on the coordinates failing: {singular[:300]}")


def chain_at_rest(solve):
    noted(solve("P52", "--set", "x0=0", "--no-simulation"), "N061")


def chain_corner(solve):
    need(solve("P52", "--no-simulation").values(key="d"), "no place where the corner would have to pull")


def retightens(solve):
    answer = solve("P54")
    said = [n["text"] for n in answer.document["notes"]] + [str(e) for e in answer.document.get("simulation", {}).get("events", [])]
    need(any("restitution" in s for s in said), f"nobody asks for a law of restitution: {said}")


def not_unique(solve):
    noted(solve("P58", "--no-simulation"), "N070")


def redundant(solve):
    answer = solve("P59", "--no-simulation")
    dof = answer.document["dof"]
    need((dof["coordinates"], dof["constraints"], dof["rank"], dof["dof"]) == (3, 3, 2, 1), f"{dof}")
    noted(answer, "N052")
    need("not determined" in texts(answer, "λ_mid"), "λ_mid is not said to be undetermined")
    need(len([c for c in answer.document["constraints"] if c["implied_by"]]) == 1, "one constraint follows from the others")


def hidden(solve):
    answer = solve("P62", "--no-simulation")
    need(len(answer.document["dof"]["hidden"]) == 1, f"{answer.document['dof']}")
    need("Its start value is not free" in texts(answer, "dof"), "the start of y")


def massless_in_flight(solve):
    answer = solve("P64_massless")
    need(answer.document["status"] in ("singular", "numerical"), f"status {answer.document['status']}")


def slack_at_once(solve):
    answer = solve("P65_string")
    events = answer.document["simulation"]["events"]
    need(events and events[0]["kind"] in ("release", "slack") and events[0]["t"] == 0, f"{events[:1]}")


REPORTS = {
    "P03": [("a start at rest on top is an equilibrium; the energy argument still gives 2/3", equilibrium_start)],
    "P09": [("at the critical speed every radius is an equilibrium", continuum)],
    "P26": [("the coordinates fail on the axis", axis_of_the_cone)],
    "P52": [("rest at x = 0 is an equilibrium start", chain_at_rest), ("where the corner would have to pull", chain_corner)],
    "P54": [("a law of restitution is asked for", retightens)],
    "P58": [("the motion is not unique", not_unique)],
    "P59": [("rank 2 of 3, one freedom, multipliers not determined", redundant)],
    "P62": [("the hidden constraint, and a start that is not free", hidden)],
    "P64": [("without mass of the hoop the flight is not determined", massless_in_flight)],
    "P65": [("above the horizontal the string is slack from the start", slack_at_once)],
}
