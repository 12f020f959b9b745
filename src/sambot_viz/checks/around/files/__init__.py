"""What the files around a model say: plugins, parameters, launch files, folders."""
