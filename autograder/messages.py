"""Everything the judge says to a learner: one catalogue, so that a translation is one file, of more than 400 lines.

A translation replaces the texts and keeps the keys and the names in braces. Hints of known mistakes are not here: they stand
beside the mistake in the exercise. The tone: first what is right, then what is wrong, where, and one thing to look at; the
geometry, never the solution.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

TEXT: dict[str, str] = {
    # --- words
    "and": " and ",
    "noun.surface": "surface",
    "noun.curve": "curve",
    "noun.solid": "solid",
    "noun.field": "field of vectors",
    "noun.basis": "set of functions",
    "noun.net": "net",
    "noun.value": "value",
    "noun.mask": "mask",
    "noun.label": "answer",
    "data.one": "the data set {names}",
    "data.many": "the data sets {names}",
    "data.with": "{name} ({arguments})",
    "hidden": "data that are not shown here",
    "amount.percent": "{number} % of its size",
    "amount.times": "{number} times its size",
    "figure.layer": "The layer {layer} of the solid",
    "given.vector": "arrays of shape {shapes}",
    "given.mesh": "arrays of shape {shapes}",
    "given.scalar": "single numbers",
    # --- what is right
    "right.all": "Right: your {noun} meets the reference at all {count} places compared, on every one of the {sets} data sets.",
    "right.all_one": "Right: your {noun} meets the reference at all {count} places compared.",
    "right.value": "Right on every one of the {sets} data sets.",
    "right.value_one": "Right.",
    "right.accepted": "This counts as right here.",
    "right.sets": "Right on {data}.",
    "right.blind": "Right on {data}, which cannot see this mistake.",
    "right.shown": "Right on all the data shown here.",
    "right.one_coordinate": "{names} is right everywhere.",
    "right.coordinates": "{names} are right everywhere.",
    "right.edges_all": "All {count} edges are right.",
    "right.edge": "The edge {names} is right.",
    "right.edges": "The edges {names} are right.",
    "right.ends": "Both ends of the curve are right.",
    "right.end": "The end {names} is right.",
    "right.faces_all": "All six faces are right.",
    "right.faces": "The faces {names} are right.",
    "right.face": "The face {names} is right.",
    "right.corners": "All {count} corners are right.",
    "right.corner": "The corner {names} is right.",
    "right.corners_some": "The corners {names} are right.",
    "right.built": "{id} does with your {names} just what it should.",
    "right.contrast": "It is right where {right}, and wrong where {wrong}.",
    "right.only_side": "It is right everywhere but {thing} {names}.",
    "right.only_sides": "It is right everywhere but {thing}s {names}.",
    "spans.but": "Along {name} it is right in every span but {run}.",
    "spans.only": "Along {name} it is right in {run} only.",
    "right.up_to": "It is right as long as {name} is at most {value}.",
    "right.from": "It is right from {name} = {value} on.",
    "right.outside": "It is right up to {name} = {low} and from {name} = {high} on.",
    "right.points": "Its points are right wherever your function takes its arguments.",
    "right.shape_of_answer": "The shape of your answer is right.",
    "right.entries": "{right} of {total} entries are right.",
    "right.words": "Your function answers with a word, as it should.",
    # --- the ladder
    "wrong.mistake": "Your {noun} is the one that comes from a well-known slip: {mistake}.",
    "wrong.mistake_close": "Your {noun} is, but for a rounded constant, the one that comes from a well-known slip: {mistake}.",
    "wrong.mistake_relabelled": (
        "Your {noun} shows two things at once. One is a well-known slip: {mistake}. The other: {relabelled}."
    ),
    "wrong.mistakes_two": "Your {noun} shows two well-known slips at once: {mistake}, and {second}.",
    "wrong.relabelled": "Right {noun}, other labels: {relabelled}. {normal}",
    "wrong.other_start": "Right {noun}, but it starts elsewhere: {shift}. {relabelled}",
    "wrong.close": "Very close, but not the same: at most {amount} away.",
    "wrong.close_float32": "Right to the seven digits that float32 holds, but float64 holds sixteen.",
    "wrong.different": "Your {noun} is another one than asked for: up to {amount} away.",
    "wrong.different_inside": "It differs inside only: all edges are right, but between them it is up to {amount} away.",
    "wrong.different_corners": "It is exact at the corners only: between them it is up to {amount} away.",
    "wrong.hidden": "It is not right on {data}.",
    "wrong.hidden_error": "Your function stops there with {exception}.",
    "wrong.same_set": (
        "Right {noun} as a set of points, but traced in another way: the point at the same {names} is another one."
    ),
    "wrong.same_set_speed": "Right {noun}, with the same corners, but {names} run at another speed along it.",
    "wrong.covered": "Right set of points, but your {noun} covers it {times} times.",
    "wrong.collapsed": "Right set of points, but {percent} of the parameter domain is squeezed into nothing.",
    "wrong.part": "Your {noun} covers only a part of the right one: about {percent} of it.",
    "wrong.part_collapsed": "Your {noun} lies on the right one, but has collapsed to {what}.",
    "wrong.part_folded": "Your {noun} lies on the right one, but covers only a part of it, some of that more than once.",
    "collapsed.curve": "a curve",
    "collapsed.less": "less",
    "wrong.more": "Your {noun} covers the right one and goes on beyond it: it is about {times} times as large.",
    "wrong.moved.translation": "Right shape, other place: moved by {shift}.",
    "wrong.moved.rotation": "Right shape, other place: turned by {angle}° about the direction {axis}.",
    "wrong.moved.screw": "Right shape, other place: turned by {angle}° about the direction {axis} and moved.",
    "wrong.moved.reflection": "Right shape, but mirrored.",
    "wrong.moved.scale": "Right shape, other size: {factor} times as large as asked for.",
    "wrong.moved.similarity": "Right shape, other size and place: {factor} times as large as asked for, and moved.",
    "wrong.moved.set": "Right shape as a set of points, but in another place and traced in another way.",
    "wrong.moved.relabelled": "Besides, {relabelled}.",
    "wrong.no_error": "For these arguments there is no answer: your function must raise ValueError, but it returned {yours}.",
    "wrong.also_no_error": "Besides, there is no answer on {data}: your function must raise ValueError there.",
    "wrong.other_error": "For these arguments your function must raise ValueError; it raised {exception} instead: {message}",
    "wrong.value": "It is not the right value.",
    "wrong.word": "“{yours}” is not the right word.",
    "wrong.word_case": "“{yours}” is right but for capitals or spaces; write it exactly as the statement does.",
    "wrong.not_word": "The answer is a word (a str); your function returned {yours}.",
    "wrong.not_number": "The answer is a number; your function returned the word “{yours}”.",
    "wrong.yes_no": "Your function says {yours} where the answer is {expected}.",
    "wrong.mask": "It says {yours} where the answer is {expected}, at {count} of {total} places.",
    "wrong.tuple": "The answer is a tuple of {expected}; your function returned {yours}.",
    "wrong.item": "Element {item} of the tuple is not right.",
    "wrong.built": "It comes out wrong only because {names}, which it calls, is not right yet.",
    "wrong.built_many": "It comes out wrong only because {names}, which it calls, are not right yet.",
    # --- what parts the data that are answered rightly from the others
    "has.square": "{names} has as many rows as columns",
    "lacks.square": "{names} has unequal numbers of rows and columns",
    "has.equal": "{names} are equal",
    "lacks.equal": "{names} differ",
    "has.negative": "{names} is negative",
    "lacks.negative": "{names} is not negative",
    "has.zero": "{names} is 0",
    "lacks.zero": "{names} is not 0",
    "has.one": "{names} is 1",
    "lacks.one": "{names} is not 1",
    "has.unit": "{names} has length 1",
    "lacks.unit": "{names} has another length than 1",
    "has.axis": "{names} lies along x, y or z",
    "lacks.axis": "{names} lies aslant",
    "has.origin": "{names} is the origin",
    "lacks.origin": "{names} is not the origin",
    "has.alike": "all numbers in {names} are the same",
    "lacks.alike": "the numbers in {names} differ",
    "has.closed": "{names} is a closed curve",
    "lacks.closed": "{names} is not a closed curve",
    "has.flat": "{names} lies in z = 0",
    "lacks.flat": "{names} leaves the plane z = 0",
    "has.from_origin": "{names} starts in the origin",
    "lacks.from_origin": "{names} does not start in the origin",
    "side.end": "at the end",
    "side.edge": "on the edge",
    "side.face": "on the face",
    "span.first": "the first",
    "span.last": "the last",
    "span.firsts": "the first {count}",
    "span.lasts": "the last {count}",
    "span.number": "number {number} of {count}",
    "span.numbers": "numbers {number} to {last} of {count}",
    # --- what a part of the points is made of
    "share": "{sum} = {fraction} of the points.",
    "share.one": "{fraction} of the points ({why}).",
    "share.term": "{factor} ({why})",
    "share.mistake": "this slip",
    "share.second": "the second slip",
    "share.relabelled_too": "other labels",
    "share.relabelled": "right but for its labels",
    "share.other_start": "right but for its start",
    "share.close": "close to right",
    "share.same_set": "the right set of points",
    "share.covered": "the right set of points, more than once",
    "share.part": "a part of it",
    "share.more": "more than it",
    "share.moved": "the right shape, elsewhere",
    "share.different": "not right",
    "share.data": "right on {right} of {of} data sets",
    "share.data_seeing": "right on {right} of {of} data sets; blind ones do not count",
    "share.data_drawn": "right on {right} of {of} data sets; blind ones and those that are everybody's do not count",
    "share.data_weighted": "right on data sets that count {right} of {of}",
    "share.partly": "since not on all",
    "share.refusal": "no ValueError where there is no answer",
    "share.shape": "not for every shape of its arguments",
    # --- relabellings: f∘σ is the reference
    "relabel.flip_u": "u runs backwards",
    "relabel.flip_w": "w runs backwards",
    "relabel.swap": "u and w are exchanged",
    "relabel.rot180": "u and w both run backwards",
    "relabel.rot90": "u and w are exchanged and one of them runs backwards (your point at (1-w, u) is the right one at (u, w))",
    "relabel.rot270": (
        "u and w are exchanged and one of them runs backwards (your point at (w, 1-u) is the right one at (u, w))"
    ),
    "relabel.antiswap": "u and w are exchanged and both run backwards",
    "relabel.flip_v": "v runs backwards",
    "relabel.flip_uv": "u and v both run backwards",
    "relabel.flip_uw": "u and w both run backwards",
    "relabel.flip_vw": "v and w both run backwards",
    "relabel.flip_uvw": "u, v and w all run backwards",
    "relabel.other": "its parameters are relabelled (your point at {formula} is the right one at ({names}))",
    "normal.flips": "The normal S_u × S_w points to the other side.",
    "normal.keeps": "The normal S_u × S_w keeps its side.",
    "shift.one": "your {name} = 0 lies where {name} = {value} should be",
    # --- facts on top of a tier
    "fact.unused": "It does not change with {name} at all.",
    "fact.constant": "It is one and the same point for all parameters.",
    "fact.coordinate_wrong": "{names} is wrong.",
    "fact.coordinates_wrong": "{names} are wrong.",
    "fact.coordinate_sign": "{name} has the wrong sign.",
    "fact.coordinate_factor": "{name} is {factor} times what it should be.",
    "fact.coordinate_offset": "{name} is off by {offset} everywhere.",
    "fact.coordinates_exchanged": "Its coordinates are exchanged: your {yours} is the right {expected}.",
    "fact.factor": "Every point is {factor} times as far from the origin as it should be.",
    "fact.steady": "How far it is off, and which way, is the same for every {names}: what it does with {names} is right.",
    "fact.factor_field": "Every vector is {factor} times as long as it should be.",
    # --- where
    "where.point": "Furthest off on {data}, at {place}: your point is {yours}, the right one is {expected}.",
    "where.vector": "Furthest off on {data}, at {place}: your vector is {yours}, the right one is {expected}.",
    "where.value": "On {data}, at {place}: you have {yours}, the right one is {expected}.",
    "where.entry": "Furthest off on {data}: {place} is {yours}, the right one is {expected}.",
    "where.number": "On {data}: you have {yours}, the right one is {expected}.",
    "where.word": "On {data}: you answer {yours}.",
    "where.data": "On {data}.",
    "where.index": "entry {index}",
    "where.element": "element {item}",
    "where.index_of_element": "entry {index} of element {item}",
    "where.line": "Line {line}: {source}",
    "where.line_only": "Line {line} of the cell that defines it.",
    # --- one thing to look at
    "look.built": "Put {names} right and check again; {id} needs no change.",
    "look.calls": "{id} calls {names}, which is not right yet: put that right first, then check again.",
    "look.calls_many": "{id} calls {names}, which are not right yet: put these right first, then check again.",
    "look.stub_earlier": "Write {names} first, then run that cell and check again.",
    "look.relabelled": "Look at which way each parameter runs in the statement: where is the point for {place}?",
    "look.swap": "Look at which parameter runs along which curve: first u along the generatrix, then w along the directrix.",
    "look.other_start": "Look at the first point, {place}: from where is the turn counted?",
    "look.close": "Look for a rounded constant (np.pi has all its digits) or for float32.",
    "look.float32": "Look for float32 or dtype=..., and leave it out.",
    "look.unused": "Look for where {name} should come in.",
    "look.steady": "Look at {zeros}: what is too much there, or missing, is so for every {names}.",
    "look.inside": "Look at the term that vanishes on the edges.",
    "look.corners": "Look at what happens between the corners: how do the points along an edge get their place?",
    "look.coordinate": "Look at the line that makes {names}.",
    "look.edge": "You start right: look at what happens as {name} grows from {start} to {end}.",
    "look.contrast": "Follow {names} through your function: which step holds in the first case only?",
    "look.only_sides": "Look at parameters of exactly {values}: which branch, or which span, do they belong to?",
    "look.spans": "Look at what is added up in that span: which points does it need, and does the sum or the loop reach them?",
    "look.interval": "Look for an if, a comparison or a rounding that changes over at about {name} = {value}.",
    "look.worst": "Take that one point and work it out by hand, step by step: where do the two part?",
    "look.part": "Look at how far the parameters take you: which point is reached at {place}?",
    "look.covered": "Look at how far you go round as a parameter runs from 0 to 1.",
    "look.collapsed": "Look for min, max or clip: what becomes of the parameters beyond the bound?",
    "look.same_set": "Look at the middle of an edge: is your point there where the statement puts it?",
    "look.moved": "Look at where the {noun} starts: what should stand at {place}?",
    "look.scale": "Look for a factor that is one too many, or a length where a radius is meant.",
    "look.mirrored": "Look at the signs: which way does it turn?",
    "look.error_expected": "Look at the statement: which arguments have no answer?",
    "look.hidden": (
        "It works for the numbers you see. Which numbers could come that you have not tried (signs, lengths, orders)?"
    ),
    "look.value": "Work this data set out by hand and compare.",
    "look.empty": "A remark, no marks lost: empty arrays of parameters should give an empty array of shape {wanted}.",
    # --- values
    "value.sign": "Every entry has the wrong sign.",
    "value.some_signs": "The numbers are right, but {count} of {total} have the wrong sign.",
    "value.factor": "It is {factor} times the right one.",
    "value.offset": "It is the right one plus {offset}.",
    "value.shifted": "The same vector is too much everywhere in your table: {shift}.",
    "value.always_off": "On every data set that is wrong it is the right one plus {offset}.",
    "value.always_larger": "It is too large on every data set that is wrong.",
    "value.always_smaller": "It is too small on every data set that is wrong.",
    "value.points_wrong": "Your table is right at all its {of} places but {places}.",
    "value.points_right": "Of the {of} places of your table only {places} are right.",
    "value.transposed": "It is the right one transposed: the axes are exchanged.",
    "value.reversed": "The right entries, but in reverse order along axis {axis}.",
    "value.rolled": "The right entries, but shifted by one along axis {axis}.",
    "value.permuted": "The right layers along axis {axis}, but in another order: the right ones stand at your {order}.",
    "value.layers": "Along axis {axis}, {count} of {of} layers are wrong (number {wrong}); the others are right.",
    "value.items": "{count} of {of} entries are wrong (number {wrong}); the others are right.",
    "value.items_factor": (
        "{count} of {of} entries are wrong (number {wrong}): they are {factor} times what they should be. The others are right."
    ),
    "value.layers_factor": (
        "Along axis {axis}, {count} of {of} layers are wrong (number {wrong}): they are {factor} times what they should be. "
        "The others are right."
    ),
    "value.entries": "{count} of {total} entries are wrong.",
    "value.shape.transposed": "The entries are right, but the axes are exchanged: shape {yours}, wanted {expected}.",
    "value.shape.reshape": "The numbers are right and in the right order, but in shape {yours}; wanted {expected}.",
    "value.shape.same_size": "There are as many numbers as wanted, but in shape {yours}; wanted {expected}.",
    "value.shape.one_more": "One too many along axis {axis}: shape {yours}, wanted {expected}.",
    "value.shape.one_less": "One too few along axis {axis}: shape {yours}, wanted {expected}.",
    "value.shape.other": "Your answer has shape {yours}, wanted {expected}.",
    # --- gates: calls that gave no answer
    "error.stub": "{id} is not written yet.",
    "error.stub_earlier": "{id} calls {names}, which is not written yet.",
    "error.stub_earlier_many": "{id} calls {names}, which are not written yet.",
    "error.missing": "There is no function {id} in this notebook.",
    "error.exception": "Your function stopped with {exception}: {message}",
    "error.writes": "Your function writes into the arrays it was given; these are not its own (here they are read-only).",
    "error.signature": "Your function does not take the arguments of {signature}: {message}",
    "error.RecursionError": "Your function calls itself without end.",
    "error.NameError": "Your function uses a name that is not defined: {message}",
    "error.SystemExit": "Your function ends the program (exit or quit) where it should return an answer.",
    "error.ZeroDivisionError": "Your function divides by zero.",
    "error.IndexError": "Your function reaches beyond the end of an array: {message}",
    "error.timeout": "Your function took too long and was stopped.",
    "error.memory": "Your function asked for more memory than there is.",
    "error.died": "Python itself ended while your function ran.",
    "error.refused": "The answer of your function cannot be taken: {message}",
    "error.not_reached": "It was not called, since an earlier call did not come back.",
    "look.stub": "Replace the line that raises NotImplementedError by your own.",
    "look.missing": "Is its name written exactly as in the task, and did its cell run without an error?",
    "look.exception": (
        "Call it yourself in a cell of its own, with the data of {data}, and read the last line of the error first."
    ),
    "look.writes": "Look for u *= ..., u[...] = ... and the like: make a new array, or a copy (u = np.array(u)) first.",
    "look.signature": "The first line must be def {signature}:",
    "look.timeout": "Look for a loop that cannot end, or one that does the same work for every point.",
    "look.memory": "Look for an array that grows with every round of a loop, or one with a row for every pair of points.",
    "look.died": "Look for exit(), or for a recursion that goes too deep.",
    "look.NameError": (
        "Was it defined in an earlier cell, and is it spelt the same? Names of one function are not known in another."
    ),
    "look.RecursionError": "Look at the case in which it should stop calling itself.",
    "look.SystemExit": "End the function with return.",
    "look.ZeroDivisionError": "For which arguments is the divisor 0? Treat these apart.",
    "look.IndexError": "Indices run from 0 to the length less 1; an array of shape (4, 4, 3) ends at [3, 3].",
    # --- gates: answers that are not numbers
    "answer.none": "Your function returned nothing (None).",
    "answer.complex": "Your function returned complex numbers; a point has real coordinates.",
    "answer.text": "Your function returned text ({text}) where numbers are wanted.",
    "answer.ragged": "The rows of your answer have different shapes, {first} and {other}; they do not make one array.",
    "answer.parts": "Your function returned its coordinates one by one, and their shapes differ: {parts}.",
    "answer.pieces": "Your function returned several pieces of different shapes; wanted is one array of shape {wanted}.",
    "answer.function": "Your function returned a {type}, not what comes out of calling it.",
    "answer.object": "Your function returned {type}; wanted is an array of numbers.",
    "answer.no_surface": "Your answer cannot be turned into a {noun}: {message}",
    "look.none": "Is the line with return missing, or is it inside an if or a loop that was not reached?",
    "look.complex": "Look for a root of a negative number, or for 1j.",
    "look.text": "Return the numbers themselves, not print(...) or str(...).",
    "look.ragged": "Make all rows the same length before they go into one array.",
    "look.parts": "Bring them to one shape (np.broadcast_arrays), then np.stack([x, y, z], axis=-1).",
    "look.pieces": "Join them: np.concatenate or np.append for numbers behind one another, np.stack for rows of one length.",
    "look.function": "Are the brackets of a call missing?",
    "look.object": "Return one array: np.stack([x, y, z], axis=-1) for points.",
    # --- gates: shapes
    "shape.some": "It does not handle {given} for {names}.",
    "shape.raised": "With {given} for {names} it stops with {exception}: {message}",
    "shape.raised_writes": "With {given} for {names} it writes into the arrays it was given.",
    "shape.coordinates_first": "With {given} for {names} it returns shape {got}; wanted is {wanted}, coordinates last.",
    "shape.own_mesh": (
        "With {given} for {names} it returns shape {got}: a mesh of all pairs; wanted is {wanted}, point by point."
    ),
    "shape.mesh_transposed": (
        "With {given} for {names} it returns shape {got}; wanted is {wanted}: the first axis belongs to u."
    ),
    "shape.one_coordinate": "With {given} for {names} it returns shape {got}: one number a point; wanted is {wanted}.",
    "shape.one_point": "With {given} for {names} it returns a single point; wanted is {wanted}, a point for each parameter.",
    "shape.parts": "With {given} for {names} the coordinates have different shapes ({parts}) and do not make one array.",
    "shape.none": "With {given} for {names} it returns nothing.",
    "shape.unreadable": "With {given} for {names} its answer is not an array of numbers.",
    "shape.other": "With {given} for {names} it returns shape {got}; wanted is {wanted}.",
    "look.coordinates_first": "The three coordinates belong on the last axis: np.stack([x, y, z], axis=-1).",
    "look.own_mesh": "Do not make a mesh inside: take u and w as they come, element by element.",
    "look.mesh_transposed": "Let u and w broadcast (np.broadcast_arrays(u, w)); do not turn the axes.",
    "look.shape": "Begin with u, w = np.broadcast_arrays(u, w), then every coordinate gets the same shape.",
    "look.shape_curve": "Use NumPy operations on the whole array (np.cos, not math.cos), then np.stack([x, y, z], axis=-1).",
    "look.numbers_only": "It handles single numbers only: use NumPy functions (np.cos, not math.cos), which take whole arrays.",
    # --- gates: finite, pointwise, repeatable
    "finite.corner": "It is not a finite number at the corner {place}.",
    "finite.edges": "It is not a finite number at {count} of {total} places, all of them on edges, such as {place}.",
    "finite.inside": "It is not a finite number at {count} of {total} places, such as {place}.",
    "finite.value": "Your answer holds an infinity or a NaN.",
    "look.finite": "Look for a division by 0, a root or a logarithm there: what should the limit be?",
    "pointwise.own_parameters": "It always returns shape {got}, whatever parameters come in.",
    "pointwise.alone": "The point for one pair of parameters changes with what else is in the array.",
    "pointwise.length": "With two places only it gives another shape than with many.",
    "pointwise.mesh": "The points of a mesh differ from the same points one by one.",
    "look.own_parameters": "Use the {names} that come in; do not make your own with linspace.",
    "look.pointwise": (
        "Look for max, min, sum, len or linspace over the parameters: each point must depend on its own {names} only."
    ),
    "repeat.other": "Called twice with the same arguments it gives two different answers.",
    "repeat.raised": "Called a second time with the same arguments it stops with {exception}: {message}",
    "look.repeat": "Look for random numbers, or for a list outside the function that grows.",
    # --- the card
    "tier.named_mistake": "slip: {name}",
    # --- the grader's own failure
    "own.failure": "This could not be judged; it is not your fault and costs no marks. Please tell your instructor: {message}",
}


def say(key: str, **facts: Any) -> str:
    """One sentence of the catalogue with its facts filled in."""
    return TEXT[key].format(**facts)


def listing(names: Iterable[str]) -> str:
    """``a, b and c``."""
    every = list(names)
    return TEXT["and"].join([", ".join(every[:-1]), every[-1]]) if len(every) > 1 else "".join(every)


def number(x: float, digits: int = 4) -> str:
    """A number with so many significant digits, without needless zeros; -0 is 0."""
    if not math.isfinite(x):
        return str(x)
    return f"{x + 0.0:.{digits}g}" if x else "0"


def written(value: ArrayLike, digits: int = 4) -> str:
    """A number, or a point or a short vector in brackets."""
    array = np.asarray(value)
    if array.dtype == bool:
        return str(bool(array)) if array.ndim == 0 else "(" + ", ".join(map(str, array.tolist())) + ")"
    size = float(np.abs(array[np.isfinite(array)]).max(initial=0.0))
    # Coordinates that are rounding errors beside the others are written 0.
    cleaned = np.where(np.abs(array) < 1e-12 * size, 0.0, array)
    if array.ndim == 0:
        return number(float(cleaned), digits)
    return "(" + ", ".join(number(float(x), digits) for x in cleaned.ravel()) + ")"


def digits_for(deviation: float, size: float) -> int:
    """So many significant digits that a deviation shows in a number of this size."""
    if not (deviation > 0 and math.isfinite(deviation) and size > 0):
        return 4
    return min(max(4, math.ceil(-math.log10(deviation / size)) + 2), 15)


def percent(share: float) -> str:
    """A share of 1 as a percentage: ``0.16 %``, ``48 %``."""
    return f"{number(100 * share, 2 if share < 1 else 3)} %"


def amount(share: float) -> str:
    """A length relative to the size: ``48 % of its size``, ``13 times its size``."""
    if share >= 3:
        return say("amount.times", number=number(share, 2))
    return say("amount.percent", number=number(100 * share, 2 if share < 1 else 3))


def place(names: tuple[str, ...], at: Iterable[float]) -> str:
    """``u = 0.25, w = 1``."""
    return ", ".join(f"{name} = {number(float(x))}" for name, x in zip(names, at, strict=True))
