"""Objects of other libraries become molecules: one module per library, imported when such an object arrives.

What an object is is told by the names of its type: nothing here imports the library, for whoever has such an object
has done so. Adapters only read the object's own attributes.
"""

from importlib import import_module

from molviz.readers.atoms import Models

ADAPTERS = {  # (library, type) → module and function
    ("ase", "Atoms"): ("from_ase", "models_of_atoms"),
    ("gemmi", "Structure"): ("from_gemmi", "models_of_structure"),
    ("gemmi", "Model"): ("from_gemmi", "models_of_model"),
    ("biotite", "AtomArray"): ("from_biotite", "models_of_array"),
    ("MDAnalysis", "AtomGroup"): ("from_mdanalysis", "models_of_group"),
    ("MDAnalysis", "Universe"): ("from_mdanalysis", "models_of_universe"),
    ("rdkit", "Mol"): ("from_rdkit", "models_of_mol"),
}
EXPECTED = (
    "a path, a Molecule, a Reading, a pair (centers (n, 3), radii (n,)), ASE Atoms, a gemmi Structure or Model, "
    "a biotite AtomArray, an MDAnalysis AtomGroup or Universe, or an RDKit Mol"
)


def models_of_object(x: object) -> Models | None:
    """Return the models of an object of another library; None where no adapter knows its type.

    Raises InputError where the object has no coordinates.
    """
    for kind in type(x).__mro__:
        adapter = ADAPTERS.get((kind.__module__.partition(".")[0], kind.__name__))
        if adapter:
            module, name = adapter
            models: Models = getattr(import_module(f"molviz.adapters.{module}"), name)(x)
            return models
    return None
