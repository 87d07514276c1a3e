"""What runs inside the sandbox: the zygote, and in each child the confinement and the notebook shell.

Only these files, ``wire.py``, ``system.py``, ``curvedata.py``, ``personal.py``, ``returned.py``, the two stand-ins and
``directrix.plot`` are visible there.
"""
