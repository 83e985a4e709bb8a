"""How far each modality can degrade: fits, limits and one report from the tables of a study."""
