"""Read the files around a model: plugins, parameters, launch files and folders."""
