"""Drawing kit for the visual shells of the NAO: solids, meshes and one file a body region."""
